"""Chromium that is driven as a person drives it: keys, clicks, colours and width, by its own protocol."""

import base64
import contextlib
import itertools
import json
import os
import shutil
import subprocess
import time

FLAGS = (
    "--headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader "
    "--enable-unsafe-swiftshader --no-first-run --disable-background-networking --disable-component-update "
    "--disable-sync --hide-scrollbars --remote-debugging-pipe"
).split()
# of each key that is pressed: its code, and the letters that it types
KEYS = {
    "Tab": (9, "\t"),
    "Enter": (13, "\r"),
    " ": (32, " "),
    "ArrowDown": (40, ""),
    "ArrowLeft": (37, ""),
    "Escape": (27, ""),
}
SHIFT = 8


# The least contrast (WCAG 2.2, 1.4.3) of a text with what is behind it, of all that is seen.
CONTRAST = """((frames) => {
  const light = (colour) => {
    const parts = colour.match(/[\\d.]+/g).map(Number), linear = parts.slice(0, 3).map((part) => {
      const share = part / 255;
      return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
    });
    const [red, green, blue] = linear;
    return { of: 0.2126 * red + 0.7152 * green + 0.0722 * blue, opaque: parts.length < 4 || parts[3] > 0.99 };
  };
  const inside = frames.map((name) => document.getElementById(name).contentDocument);
  let worst = [99, ""];
  for (const page of [document, ...inside]) {
    const styleOf = (element) => page.defaultView.getComputedStyle(element);
    const walker = page.createTreeWalker(page.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const within = walker.currentNode.parentElement, words = walker.currentNode.data.trim();
      if (!words || !within.checkVisibility() || within.closest("script, :disabled, option")) continue;
      let behind = within, ground = { of: 1 };
      for (; behind; behind = behind.parentElement) {
        const own = light(styleOf(behind).backgroundColor);
        if (own.opaque) { ground = own; break; }
      }
      const [low, high] = [light(styleOf(within).color).of, ground.of].sort((a, b) => a - b);
      const ratio = (high + 0.05) / (low + 0.05);
      if (ratio < worst[0]) worst = [ratio, words.slice(0, 60)];
    }
  }
  return worst;
})"""


class Browser:
    """One page of a browser of its own; a context that ends it."""

    def __init__(self, folder, width=1280, height=900, *, dark=False):
        self._numbers = itertools.count(1)
        to_read, self._to = os.pipe()
        self._from, to_write = os.pipe()

        def place_pipes():
            # the protocol reads from 3 and writes to 4
            os.dup2(os.dup(to_read), 3)
            os.dup2(os.dup(to_write), 4)

        command = [shutil.which("chromium"), *FLAGS, f"--user-data-dir={folder}", "about:blank"]
        self._process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, close_fds=False,
            preexec_fn=place_pipes,
        )  # fmt: skip
        os.close(to_read)
        os.close(to_write)
        self._read = os.fdopen(self._from, "rb", buffering=0)
        self._rest, self._session, self._events = b"", None, []
        target = next(one for one in self.tell("Target.getTargets")["targetInfos"] if one["type"] == "page")
        attached = self.tell("Target.attachToTarget", targetId=target["targetId"], flatten=True)
        self._session = attached["sessionId"]
        self.tell("Page.enable")
        self.resize(width, height)
        self.colours(dark=dark)

    def __enter__(self):
        return self

    def __exit__(self, *fault):
        with contextlib.suppress(Exception):
            self._process.terminate()
            self._process.wait(10)
        self._read.close()
        os.close(self._to)

    def tell(self, method, **params):
        """Return the answer to a command of the protocol."""
        own = {"id": next(self._numbers), "method": method, "params": params}
        own |= {"sessionId": self._session} if self._session else {}
        os.write(self._to, json.dumps(own).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == own["id"]:
                if "error" in answer:
                    raise AssertionError(f"{method}: {answer['error']}")
                return answer["result"]
            self._events.append(answer)

    def _next(self):
        while b"\0" not in self._rest:
            more = os.read(self._from, 1 << 20)
            if not more:
                raise AssertionError("the browser has ended")
            self._rest += more
        text, _, self._rest = self._rest.partition(b"\0")
        return json.loads(text)

    def resize(self, width, height):
        """Make the page as wide and high [px]."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.tell("Emulation.setDeviceMetricsOverride", **size)

    def colours(self, *, dark):
        """Prefer dark or light colours, and motion as it is."""
        own = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
        self.tell("Emulation.setEmulatedMedia", features=own)

    def open(self, address):
        """Open an address, and wait for its page."""
        self.tell("Page.navigate", url=address)
        self.until("document.readyState === 'complete' && location.href !== 'about:blank'")

    def evaluate(self, script):
        """Return the value of an expression of the page."""
        own = {"expression": script, "returnByValue": True, "awaitPromise": True}
        answer = self.tell("Runtime.evaluate", **own)
        if "exceptionDetails" in answer:
            raise AssertionError(json.dumps(answer["exceptionDetails"])[:600])
        return answer["result"].get("value")

    def until(self, script, seconds=60.0):
        """Wait until an expression of the page holds."""
        end = time.monotonic() + seconds
        while not self.evaluate(f"Boolean({script})"):
            if time.monotonic() > end:
                raise AssertionError(f"after {seconds:g} s not yet: {script}")
            time.sleep(0.05)

    def press(self, key, times=1, *, shift=False):
        """Press a key, as on a keyboard."""
        code, text = KEYS[key] if key in KEYS else (ord(key.upper()), key)
        own = {"key": key, "windowsVirtualKeyCode": code, "modifiers": SHIFT if shift else 0}
        for _ in range(times):
            letters = {"text": text} if text else {}
            self.tell("Input.dispatchKeyEvent", type="keyDown" if text else "rawKeyDown", **own, **letters)
            self.tell("Input.dispatchKeyEvent", type="keyUp", **own)

    def type(self, text):
        """Type letters where the focus is."""
        for letter in text:
            self.press(letter)

    def tab_to(self, script, most=60):
        """Press Tab until the element in focus is the one of an expression."""
        for _ in range(most):
            if self.evaluate(f"document.activeElement === ({script})"):
                return
            self.press("Tab")
        raise AssertionError(f"{most} times Tab do not lead to {script}")

    def least_contrast(self, *frames):
        """Return the least contrast of a text that is seen on the page or in its frames, and the text."""
        return self.evaluate(f"{CONTRAST}({json.dumps(frames)})")

    def click(self, x, y, *, moved=0.0):
        """Press the mouse at a place [px] of what is seen, move it to the right, and let it go."""
        own = {"button": "left", "clickCount": 1}
        self.tell("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, **own)
        if moved:
            self.tell("Input.dispatchMouseEvent", type="mouseMoved", x=x + moved, y=y, button="left")
        self.tell("Input.dispatchMouseEvent", type="mouseReleased", x=x + moved, y=y, **own)

    def choose_by_key(self, path):
        """Open the dialog of the file input that has the focus with a key, and choose a file in it."""
        self.tell("Page.setInterceptFileChooserDialog", enabled=True)
        self._events.clear()
        self.press(" ")
        while not (opened := [one for one in self._events if one["method"] == "Page.fileChooserOpened"]):
            self._events.append(self._next())
        node = opened[0]["params"]["backendNodeId"]
        self.tell("DOM.setFileInputFiles", files=[str(path)], backendNodeId=node)

    def picture(self, path, *, whole=True):
        """Write what is seen as PNG; ``whole``: however long the page is."""
        data = self.tell("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"]
        path.write_bytes(base64.b64decode(data))
