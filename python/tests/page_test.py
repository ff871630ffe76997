"""The page in a real browser: contents, mouse, touch and keys."""
import re

import browser as of_browser
import numpy as np
import pytest
from browser import picture, settle
from conftest import SCENE

from errbound import ccd, io, show

pytest.importorskip("playwright", reason="no playwright: pip install playwright")
pytest.importorskip("PIL", reason="no pillow: pip install pillow")

# A rod, a point that falls past it, and another in its path: ve, ve, vv.
RODS = ([[0, 0, 0], [1, 0, 0], [.5, 0, 1], [.5, 0, 2]], [[0, 0, 0], [1, 0, 0], [.5, 0, -1], [.5, 0, -4]])


@pytest.fixture(scope="module")
def browser():
    path = of_browser.find()
    if path is None:
        pytest.skip(f"no browser: none of {', '.join(of_browser.NAMES)} on PATH, nor ERRBOUND_BROWSER")
    with of_browser.headless(path) as found:
        yield found


@pytest.fixture(scope="module")
def step(scene):
    before, after = scene
    return ccd.step(before.vertices, after.vertices, before.faces, times=True)


@pytest.fixture(scope="module")
def file(scene, step, tmp_path_factory):
    return show(*scene, step, tmp_path_factory.mktemp("page") / "step.html")


@pytest.fixture
def opened(browser):
    """Opens pages. At the end, no page may have logged a message or requested another file."""
    message, context = [], browser.new_context(viewport={"width": 1000, "height": 600}, has_touch=True)

    def open_page(path):
        page, url = context.new_page(), path.resolve().as_uri()
        page.on("console", lambda message: message.append(message.text))
        page.on("pageerror", lambda error: message.append(str(error)))
        page.on("request", lambda r: message.append(r.url) if r.url not in (url, "data:,") else None)
        page.goto(url)
        settle(page)
        return page

    yield open_page
    context.close()
    assert message == []


@pytest.fixture
def page(opened, file):
    page = opened(file)
    page.select_option("#order", "listed")
    return page


def listed(page):
    return [row.split("\n") for row in page.locator(".row").all_inner_texts()]


def row_of(pair, first):
    return " | ".join(" ".join(map(str, part)) for part in (pair[:first], pair[first:]))


def test_the_mesh_and_its_pairs_are_in_the_picture(page):
    pixels = picture(page).reshape(-1, 3).astype(int)
    red, green, blue = pixels.T
    assert (pixels < 250).any(axis=1).mean() > 0.05
    assert (pixels == 255).all(axis=1).mean() > 0.2  # the background
    assert ((red > 120) & (green < 70) & (blue < 70)).sum() > 20  # faces that are hit
    assert ((red < 60) & (green < 120) & (blue > 150)).sum() > 50  # edges that meet
    before = len(np.unique(pixels, axis=0))
    page.uncheck("#through")
    assert np.mean(picture(page).reshape(-1, 3) != pixels) > 0.005
    for box in "faces", "pairs":
        page.uncheck(f"#{box}")
    assert (picture(page) == 255).all()
    page.check("#wires")
    assert before > 100 and (picture(page) < 200).any()


def test_the_list_is_of_all_pairs(page, step):
    assert page.inner_text("#count") == f"{len(step.pairs)} pairs"
    assert page.inner_text("#kinds") == (f"{len(step.pairs.vertex_face)} vertex/face, "
                                         f"{len(step.pairs.edge_edge)} edge/edge")
    rows = listed(page)
    low = step.times["vertex_face"]["low"]
    for i, (number, kind, vertices, time) in enumerate(rows):
        assert (number, kind, vertices) == (str(i), "vf", row_of(step.pairs.vertex_face[i].tolist(), 1))
        assert float(time) == pytest.approx(low[i], rel=1e-5)
    seen = set()
    for _ in range(len(step.pairs)):
        numbers = {int(row[0]) for row in listed(page)}
        if numbers <= seen:
            break
        seen |= numbers
        page.evaluate("document.getElementById('list').scrollTop += 200")
        settle(page)
    assert seen == set(range(len(step.pairs)))
    assert listed(page)[-1][1:3] == ["ee", row_of(step.pairs.edge_edge[-1].tolist(), 2)]


def test_a_row_is_looked_at_and_is_a_query(page, scene, step, program, tmp_path):
    whole = picture(page)
    for i in 0, 3:
        page.locator(f"#pair-{i}").click()
        assert page.locator("[aria-selected=true]").get_attribute("id") == f"pair-{i}"
        assert np.mean(picture(page) != whole) > 0.05
        low, high = (step.times["vertex_face"][end][i] for end in ("low", "high"))
        assert {float(t) for t in re.findall(r"\d\.[\de+-]*\d", page.inner_text("#when"))} == {low, high}
        assert float(page.inner_text("#shown-time")) == low
        contact = ccd.first_contact(step.pairs.vertex_face[[i]], "vertex_face",
                                    positions=[frame.vertices for frame in scene])
        *weights, x, y, z = map(float, re.findall(r"-?\d[\d.]*(?:e-?\d+)?(?= of|[,)])", page.inner_text("#where")))
        assert weights == pytest.approx(contact.weights[0], rel=1e-3)
        assert (x, y, z) == pytest.approx(contact.normal[0], rel=1e-3)
        rows = [list(map(float, row.split(","))) for row in page.inner_text("#query").split()]
        expected = [frame.vertices[step.pairs.vertex_face[i]] for frame in scene]
        np.testing.assert_array_equal(rows, np.concatenate(expected))
    (tmp_path / "vf.csv").write_text(page.inner_text("#query").strip() + "\n")
    assert ccd.decide(io.read_queries(tmp_path / "vf.csv").queries, "vertex_face").collides.tolist() == [True]
    page.click("#whole")
    page.uncheck("#cut")
    page.fill("#time", "1")
    # The selected pair stays orange.
    assert np.mean(picture(page) != whole) < 0.05


def test_faces_in_front_of_the_selected_pair_are_cut(page):
    def orange():
        red, green, blue = picture(page).reshape(-1, 3).astype(int).T
        return ((red > 230) & (green > 110) & (green < 160) & (blue < 60)).sum()

    page.locator("#pair-6").click()
    page.evaluate("camera.distance *= 3")
    page.check("#wires")
    cut = picture(page)
    page.uncheck("#cut")
    assert np.mean(picture(page) != cut) > 0.1
    assert orange() > 100  # visible through faces in front


def test_orders_and_vertices(opened, file, step):
    page = opened(file)
    assert page.input_value("#order") == "time"
    lows = np.concatenate([step.times[kind]["low"] for kind in ccd.POINTS])
    assert [int(row[0]) for row in listed(page)] == np.argsort(lows, kind="stable")[:len(listed(page))].tolist()
    pair = step.pairs.edge_edge[7]
    page.fill("#vertex", str(pair[2]))
    expected = sum(int((of_kind == pair[2]).any(axis=1).sum())
                   for of_kind in (step.pairs.vertex_face, step.pairs.edge_edge))
    assert page.inner_text("#chosen") == f"{expected} of them"
    assert all(str(pair[2]) in row[2].split() for row in listed(page))


def test_keys_go_through_the_list(page):
    page.locator("#pair-0").click()
    page.locator("#list").press("ArrowDown")
    assert page.locator("[aria-selected=true]").get_attribute("id") == "pair-1"
    page.locator("#list").press("ArrowUp")
    page.locator("#list").press("ArrowUp")
    assert page.locator("[aria-selected=true]").get_attribute("id") == "pair-0"


def test_the_slider_moves_the_mesh(page):
    seen = []
    for t in "0", "0.5", "1":
        page.fill("#time", t)
        assert page.inner_text("#shown-time") == t
        seen.append(picture(page))
    assert all((a != b).any() for a, b in zip(seen, seen[1:] + seen[:1]))


def drag(page, button="left", keys=()):
    for key in keys:
        page.keyboard.down(key)
    page.mouse.move(300, 200)
    page.mouse.down(button=button)
    page.mouse.move(360, 230, steps=3)
    page.mouse.up(button=button)
    for key in keys:
        page.keyboard.up(key)


def test_mouse(page):
    seen = [picture(page)]
    for act in (lambda: drag(page), lambda: drag(page, "right"), lambda: drag(page, keys=["Shift"]),
                lambda: page.mouse.wheel(0, -300), lambda: page.select_option("#up", "y")):
        act()
        seen.append(picture(page))
        assert np.mean(seen[-1] != seen[-2]) > 0.01
    page.select_option("#up", "z")
    page.click("#whole")
    assert (picture(page) == seen[0]).all()


def touch(session, kind, *places):
    session.send("Input.dispatchTouchEvent", {
        "type": kind, "touchPoints": [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(places)]})


def test_fingers(page):
    session, distances = page.context.new_cdp_session(page), []
    for turns in ([(200, 200)], [(260, 240)]), ([(250, 200), (350, 200)], [(200, 200), (400, 200)]):
        before = picture(page)
        touch(session, "touchStart", *turns[0])
        touch(session, "touchMove", *turns[1])
        touch(session, "touchEnd")
        assert np.mean(picture(page) != before) > 0.01
        distances.append(page.evaluate("camera.distance"))
    assert distances[1] == pytest.approx(distances[0] / 2, rel=0.1)  # the distance of the fingers doubled


def test_a_click_on_a_mark_chooses_its_pair(page, step):
    page.locator("#pair-5").click()
    chosen = page.inner_text("#what")
    place = page.evaluate("""() => {
        const t = time(), {before, after} = scene.marks;
        const [x, y] = camera.project([0, 1, 2].map(a => before[15 + a] * (1 - t) + after[15 + a] * t));
        const box = element("picture").getBoundingClientRect();
        return [box.left + box.width / 2 + x * box.height, box.top + box.height / 2 + y * box.height];
    }""")
    page.locator("#pair-0").click()
    assert page.inner_text("#what") != chosen
    page.evaluate("const {middle, radius} = placeOfPair(pairOf(step, 5)); camera.look(middle, 2.5 * radius)")
    page.fill("#time", str(step.times["vertex_face"]["low"][5]))
    page.mouse.move(*place)
    page.mouse.down()
    page.mouse.move(place[0] + 40, place[1])
    page.mouse.move(*place)
    page.mouse.up()
    assert page.inner_text("#what") != chosen  # a drag is no click
    page.mouse.click(*place)
    assert page.inner_text("#what") == chosen


def test_rods_points_and_no_times(opened, tmp_path):
    before, after = (io.Mesh(np.array(x, float), np.empty((0, 3), int), np.array([[0, 1]])) for x in RODS)
    found = ccd.step(before.vertices, after.vertices, before.faces, before.edges)
    page = opened(show(before, after, found, tmp_path / "rods.html"))
    assert [row[1:] for row in listed(page)] == [["ve", "2 | 0 1"], ["ve", "3 | 0 1"], ["vv", "2 | 3"]]
    assert (picture(page) < 100).any()
    page.locator("#pair-2").click()
    assert page.inner_text("#when") == "The first time was not computed."
    assert page.locator("#order option").count() == 1


@pytest.mark.parametrize("scale", [1e-320, 1e300])
def test_any_size_is_shown(opened, tmp_path, scale):
    triangles = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [.2, .2, 1], [.4, .2, 1.1], [.2, .4, 1.2]]) * scale
    before, after = (io.Mesh(x, np.arange(6).reshape(2, 3)) for x in (triangles, triangles * [1, 1, -1]))
    found = ccd.step(before.vertices, after.vertices, before.faces, times=True)
    page = opened(show(before, after, found, tmp_path / "size.html"))
    assert page.inner_text("#count") == f"{len(found.pairs)} pairs" and len(found.pairs) > 0
    assert (picture(page) < 240).any(axis=2).mean() > 0.02


def test_nothing_touches(opened, tmp_path):
    mesh = io.Mesh(np.eye(3), np.arange(3).reshape(1, 3))
    found = ccd.step(mesh.vertices, mesh.vertices, mesh.faces, times=True)
    page = opened(show(mesh, mesh, found, tmp_path / "none.html"))
    assert page.inner_text("#count") == "0 pairs" and listed(page) == []
    assert (picture(page) < 240).any()


def test_a_large_step_opens(opened, shared_data, tmp_path):
    frames = shared_data / "scenes" / "cloth-ball" / "frames"
    before, after = (io.read_mesh(frames / f"cloth_ball{i}.ply") for i in (92, 93))
    found = ccd.step(before.vertices, after.vertices, before.faces, times=True)
    path = show(before, after, found, tmp_path / "large.html")
    assert path.stat().st_size < 15e6
    page = opened(path)
    page.select_option("#order", "listed")
    assert page.inner_text("#count") == f"{len(found.pairs):,} pairs"
    page.evaluate("document.getElementById('list').scrollTop = 1e9")
    settle(page)
    assert listed(page)[-1][0] == str(len(found.pairs) - 1)


def test_the_program_makes_the_same_page(program, file, tmp_path):
    import subprocess

    subprocess.run([program, "step", SCENE / "frame0.ply", SCENE / "frame1.ply", "--view", tmp_path / "step.html",
                    "--toi", tmp_path / "times"], check=True, stdout=subprocess.DEVNULL)
    assert (tmp_path / "step.html").read_bytes() == file.read_bytes()
