"""A headless browser with software WebGL, and screenshots as arrays."""
import io
import os
import shutil
from contextlib import contextmanager

import numpy as np

NAMES = ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"]


def find():
    """Returns the path of ERRBOUND_BROWSER or of a browser on PATH, or None."""
    return os.environ.get("ERRBOUND_BROWSER") or next(filter(None, map(shutil.which, NAMES)), None)


@contextmanager
def headless(path):
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=[
            "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"])
        yield browser
        browser.close()


def settle(page):
    page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


def picture(page):
    from PIL import Image

    settle(page)
    box = page.locator("#picture").bounding_box()
    box["height"] = page.locator("#controls").bounding_box()["y"] - box["y"]
    return np.asarray(Image.open(io.BytesIO(page.screenshot(clip=box))).convert("RGB"))
