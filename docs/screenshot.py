"""Take a picture of the head of a page as a browser shows it.

Example: python docs/screenshot.py results/lbracket_30x20x15/report.html docs/report.png
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SIZE = (1280, 1150)
NAMES = ("chromium", "chromium-browser", "google-chrome")
FLAGS = (
    "--headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader "
    "--enable-unsafe-swiftshader --hide-scrollbars --virtual-time-budget=8000"
).split()


def take(page, picture, size=SIZE):
    """Write what a browser shows of a page, a file or an address, to a PNG of ``size``; its exit status."""
    browser = next(filter(None, map(shutil.which, NAMES)), None)
    if browser is None:
        print("no browser is installed: the picture stays as it is", file=sys.stderr)
        return 0
    with tempfile.TemporaryDirectory() as profile:
        call = [browser, *FLAGS, f"--user-data-dir={profile}", f"--window-size={size[0]},{size[1]}"]
        call += [
            f"--screenshot={Path(picture).resolve()}",
            page if str(page).startswith("http") else Path(page).resolve().as_uri(),
        ]
        return subprocess.run(call, stderr=subprocess.DEVNULL, timeout=120).returncode


if __name__ == "__main__":
    sys.exit(take(*sys.argv[1:3]))
