"""A headless browser for pages, with WebGL by software, and pictures of them as arrays."""
import io
import os
import shutil
from contextlib import contextmanager

import numpy as np

NAMES = ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"]


def find():
    """The browser's path, ERRBOUND_BROWSER or one of those on PATH, or None."""
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
    """Until what was asked for is drawn."""
    page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


def picture(page):
    """The pixels above the controls, (height, width, 3)."""
    from PIL import Image

    settle(page)
    box = page.locator("#picture").bounding_box()
    box["height"] = page.locator("#controls").bounding_box()["y"] - box["y"]
    return np.asarray(Image.open(io.BytesIO(page.screenshot(clip=box))).convert("RGB"))
