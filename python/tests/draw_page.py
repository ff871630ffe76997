"""Draws docs/page.png: the page of the bundled scene's step, with a selected pair.

    out/python/env/bin/python python/tests/draw_page.py docs/page.png
"""
import sys
import tempfile
from io import BytesIO
from pathlib import Path

import browser
from conftest import SCENE
from PIL import Image

from errbound import ccd, io, show


def main():
    before, after = (io.read_mesh(SCENE / f"frame{i}.ply") for i in (0, 1))
    step = ccd.step(before.vertices, after.vertices, before.faces, times=True)
    with tempfile.TemporaryDirectory() as folder, browser.headless(browser.find()) as found:
        page = found.new_page(viewport={"width": 1000, "height": 520})
        page.goto(show(before, after, step, Path(folder) / "step.html").as_uri())
        page.check("#wires")
        page.locator("#pair-6").click()
        page.evaluate("camera.distance *= 2.2; camera.pitch = .3; redraw()")
        browser.settle(page)
        picture = Image.open(BytesIO(page.screenshot()))
    picture.convert("RGB").quantize(200).save(sys.argv[1], optimize=True)


main()
