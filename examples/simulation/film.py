"""Draws a run of `simulate`, without a display: a contact sheet and a film.

Arguments: the run's folder (with frames/*.ply) and options (--help). Writes sheet.png and film.gif into the folder.
Triangles are drawn from far to near, with one colour per body.
"""
import argparse
import pathlib
import re
import sys

try:
    import numpy
    from PIL import Image, ImageDraw
except ImportError as missing:
    sys.exit(f"film.py: {missing}; expected NumPy and Pillow (pip install numpy pillow, or on Debian "
             "python3-matplotlib and /usr/bin/python3)")

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from meshes import bodies_of, read_ply  # noqa: E402

COLOURS = numpy.array([[86, 130, 196], [214, 128, 66], [105, 164, 103], [186, 92, 110],
                       [139, 116, 178], [120, 120, 120]], float)
BACKGROUND = (250, 250, 248)


class camera:
    def __init__(self, eye, target, size):
        forward = target - eye
        forward /= numpy.linalg.norm(forward)
        right = numpy.cross(forward, [0, 0, 1])
        right /= numpy.linalg.norm(right)
        self.eye, self.axes = eye, numpy.array([right, numpy.cross(right, forward), forward])
        self.size = size

    def project(self, points):
        local = (points - self.eye) @ self.axes.T
        width, height = self.size
        scale = 1.4 * height / numpy.maximum(local[:, 2:], 1e-6)
        pixels = local[:, :2] * scale * [1, -1] + [width / 2, height / 2]
        return pixels, local[:, 2]


def picture(points, faces, edges, body, view):
    image = Image.new("RGB", view.size, BACKGROUND)
    draw = ImageDraw.Draw(image)
    pixels, depth = view.project(points)
    corners = points[faces]
    normal = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = numpy.linalg.norm(normal, axis=1)
    light = numpy.abs(normal @ (view.axes.T @ [0.3, 0.5, -0.8])) / numpy.where(length > 0, length, 1)
    shade = COLOURS[body[faces[:, 0]] % len(COLOURS)] * (0.35 + 0.65 * light[:, None])
    shapes = [(depth[f].mean(), f, tuple(c)) for f, c in zip(faces, shade.astype(int))]
    shapes += [(depth[e].mean(), e, (60, 60, 60)) for e in edges]
    for _, shape, colour in sorted(shapes, key=lambda s: -s[0]):
        if (depth[shape] <= 0).any():
            continue
        outline = [tuple(p) for p in pixels[shape]]
        draw.line(outline, colour, 2) if len(shape) == 2 else draw.polygon(outline, colour)
    return image


def arguments():
    parser = argparse.ArgumentParser(description="A contact sheet and a film of a run.")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--eye", type=float, nargs=3, help="by default from run.txt")
    parser.add_argument("--target", type=float, nargs=3, help="by default from run.txt")
    parser.add_argument("--size", type=int, nargs=2, default=(480, 400), metavar=("W", "H"))
    parser.add_argument("--pictures", type=int, default=60, help="number of pictures of the film")
    return parser.parse_args()


def main():
    given = arguments()
    frames = sorted((given.folder / "frames").glob("*.ply"), key=lambda path: int(path.stem))
    if not frames:
        sys.exit(f"film: number of frames in {given.folder} is 0; expected frames/*.ply")
    text = (given.folder / "run.txt").read_text()
    recorded = {name: [float(x) for x in values.split()]
            for name, values in re.findall(r"^(eye|target) (.*)$", text, re.MULTILINE)}
    view = camera(numpy.array(given.eye or recorded["eye"]), numpy.array(given.target or recorded["target"]),
                  tuple(given.size))
    chosen = sorted({round(i) for i in numpy.linspace(0, len(frames) - 1, given.pictures)})
    body, film = None, []
    for i in chosen:
        points, faces, edges = read_ply(frames[i])
        if body is None:
            body = bodies_of(faces, len(points))
        film.append(picture(points, faces, edges, body, view))
    film[0].save(given.folder / "film.gif", save_all=True, append_images=film[1:], duration=60, loop=0)
    few = [film[round(i)] for i in numpy.linspace(0, len(film) - 1, min(8, len(film)))]
    width, height = view.size
    sheet = Image.new("RGB", (4 * width, -(-len(few) // 4) * height), BACKGROUND)
    for i, image in enumerate(few):
        sheet.paste(image, (i % 4 * width, i // 4 * height))
    sheet.save(given.folder / "sheet.png")
    print(f"pictures: {given.folder / 'sheet.png'}, {given.folder / 'film.gif'}")


if __name__ == "__main__":
    main()
