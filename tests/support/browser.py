"""A page in a browser without a window, and what a script of it says by the page's title."""

import json
import re
import shutil
import subprocess
from html import unescape

FLAGS = (
    "--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync --use-gl=angle --use-angle=swiftshader "
    "--enable-unsafe-swiftshader --hide-scrollbars --window-size=1280,900 --enable-logging=stderr"
).split()
ADVICE = ("GL Driver Message", "will-read-frequently")  # about the speed of drawing without a graphics card


def visit(folder, text, *flags, budget=6000):
    """Load a page with more flags; gives what came to stdout and the lines of the console."""
    (folder / "page.html").write_text(text, encoding="utf-8")
    own = [f"--user-data-dir={folder / 'profile'}", f"--virtual-time-budget={budget}"]
    command = [shutil.which("chromium"), *FLAGS, *own, *flags, f"file://{folder / 'page.html'}"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    lines = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
    return done.stdout, [line for line in lines if not any(word in line for word in ADVICE)]


def title(dom):
    return unescape(re.search(r"<title>(.*?)</title>", dom, re.S).group(1))


def probed(folder, text, script, *flags, quiet=True, budget=6000):
    """What a script at the end of a page puts into its title as JSON, and the page."""
    dom, console = visit(folder, text.replace("</body>", script), *flags, "--dump-dom", budget=budget)
    assert console == [] or not quiet
    return json.loads(title(dom)), dom
