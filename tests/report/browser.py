"""A headless Chromium through chromedriver, with nothing but Python's standard library, and what its screenshots hold."""
import base64
import json
import os
import shutil
import struct
import subprocess
import tempfile
import time
import urllib.error
import urllib.request
import zlib

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # the key of an element's id, fixed by the WebDriver standard


def missing():
    """The programs that lack here, as a text; empty: none."""
    lacking = [name for name in ("chromedriver", "chromium") if not shutil.which(name)]
    return " and ".join(lacking)


class Picture:
    """An 8-bit RGB or RGBA PNG, decoded."""

    def __init__(self, png):
        data, at = b"", 8
        while at < len(png):
            length, kind = struct.unpack(">I4s", png[at : at + 8])
            body = png[at + 8 : at + 8 + length]
            if kind == b"IHDR":
                self.width, self.height, depth, color, _, _, interlace = struct.unpack(">IIBBBBB", body)
                assert depth == 8 and color in (2, 6) and not interlace, "this PNG is of another kind"
                self.channels = 3 if color == 2 else 4
            if kind == b"IDAT":
                data += body
            at += 12 + length
        self.rows = self.unfilter(zlib.decompress(data))

    def unfilter(self, data):
        rows, step, size = [], self.channels, self.width * self.channels
        above = bytearray(size)
        for y in range(self.height):
            start = y * (size + 1)
            kind, row = data[start], bytearray(data[start + 1 : start + 1 + size])
            for i in range(size if kind else 0):
                left = row[i - step] if i >= step else 0
                up = above[i]
                corner = above[i - step] if i >= step else 0
                if kind == 1:
                    row[i] = row[i] + left & 255
                elif kind == 2:
                    row[i] = row[i] + up & 255
                elif kind == 3:
                    row[i] = row[i] + (left + up) // 2 & 255
                else:
                    guess = left + up - corner
                    row[i] = row[i] + min((left, up, corner), key=lambda v: abs(guess - v)) & 255
            rows.append(row)
            above = row
        return rows

    def at(self, x, y):
        x, y = int(x), int(y)
        return tuple(self.rows[y][x * self.channels : x * self.channels + 3])


class Browser:
    """One browser with one window. `close()` ends it and its driver."""

    def __init__(self, width=1400, height=900):
        self.folder = tempfile.mkdtemp(prefix="peelray-browser-")
        # Port 0: the driver picks a free one and says which.
        self.log_path = os.path.join(self.folder, "driver.log")
        self.log = open(self.log_path, "wb")
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=self.log, stderr=self.log)
        self.session = None
        try:
            self.address = f"http://127.0.0.1:{self.port()}"
            self.session = self.call("POST", "/session", {"capabilities": {"alwaysMatch": self.wishes(width, height)}})["sessionId"]
        except BaseException:
            self.close()
            raise

    def wishes(self, width, height):
        # Containers: root may not use the sandbox, and /dev/shm is small. No host name is ever resolved.
        flags = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu", "--hide-scrollbars",
                 "--force-device-scale-factor=1", "--host-resolver-rules=MAP * ~NOTFOUND",
                 f"--window-size={width},{height}", "--user-data-dir=" + os.path.join(self.folder, "profile")]
        return {"browserName": "chrome", "goog:chromeOptions": {"args": flags, "binary": shutil.which("chromium")},
                "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}

    def port(self):
        for _ in range(300):
            with open(self.log_path) as log:
                for line in log:
                    if "started successfully on port" in line:
                        return int(line.rstrip(". \n").split()[-1])
            if self.driver.poll() is not None:
                break
            time.sleep(0.1)
        with open(self.log_path) as log:
            raise RuntimeError("chromedriver did not start:\n" + log.read())

    def close(self):
        try:
            if self.session:
                self.call("DELETE", "")
        finally:
            self.driver.terminate()
            self.driver.wait()
            self.log.close()
            shutil.rmtree(self.folder, ignore_errors=True)

    def call(self, method, path, body=None):
        prefix = f"/session/{self.session}" if self.session else ""
        data = None if method != "POST" else json.dumps(body or {}).encode()
        request = urllib.request.Request(self.address + prefix + path, data, {"Content-Type": "application/json"}, method=method)
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))  # the driver is here, whatever the environment says
        try:
            with opener.open(request, timeout=120) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            value = json.load(error)["value"]
            raise RuntimeError(f"{path}: {value['error']}: {value['message']}") from None

    def cdp(self, command, **arguments):
        """A command of Chromium's own protocol: what WebDriver has no words for."""
        return self.call("POST", "/goog/cdp/execute", {"cmd": command, "params": arguments})

    @staticmethod
    def address_of(path):
        return "file://" + urllib.request.pathname2url(os.path.abspath(path))

    def open(self, path):
        self.call("POST", "/url", {"url": self.address_of(path)})

    def run(self, script, *arguments):
        """What a script returns: run("return 1 + 1")."""
        return self.call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def wait(self, condition, what):
        for _ in range(100):
            if self.run("return " + condition):
                return
            time.sleep(0.1)
        raise AssertionError("waited 10 s for " + what)

    def act(self, *sources):
        self.call("POST", "/actions", {"actions": list(sources)})
        self.call("DELETE", "/actions")

    def mouse(self, *moves, kind="mouse"):
        """Presses at the first point, moves through the others, lets go at the last."""
        to = lambda p, duration: {"type": "pointerMove", "x": int(p[0]), "y": int(p[1]), "duration": duration}
        actions = [to(moves[0], 0), {"type": "pointerDown", "button": 0}, *[to(p, 100) for p in moves[1:]], {"type": "pointerUp", "button": 0}]
        self.act({"type": "pointer", "id": kind, "parameters": {"pointerType": kind}, "actions": actions})

    def hover(self, x, y):
        """Leaves the mouse there."""
        move = {"type": "pointerMove", "x": int(x), "y": int(y), "duration": 0}
        self.call("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": [move]}]})

    def wheel(self, x, y, amount):
        scroll = {"type": "scroll", "x": int(x), "y": int(y), "deltaX": 0, "deltaY": amount, "duration": 0}
        self.act({"type": "wheel", "id": "wheel", "actions": [scroll]})

    def key(self, *keys):
        """Presses one after the other; a tuple's keys together."""
        actions = []
        for key in keys:
            together = key if isinstance(key, tuple) else (key,)
            actions += [{"type": "keyDown", "value": k} for k in together] + [{"type": "keyUp", "value": k} for k in reversed(together)]
        self.act({"type": "key", "id": "keys", "actions": actions})

    def touch(self, *frames):
        """Fingers: a list of points per frame; the first touches, the others move, then all lift."""
        for index, points in enumerate(frames):
            fingers = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]
            self.cdp("Input.dispatchTouchEvent", type="touchMove" if index else "touchStart", touchPoints=fingers)
        self.cdp("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def phone(self, width=390, height=844, density=2):
        self.cdp("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=density, mobile=True)
        self.cdp("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=5)

    def media(self, kind="", scheme="light"):
        self.cdp("Emulation.setEmulatedMedia", media=kind, features=[{"name": "prefers-color-scheme", "value": scheme}])

    def screenshot(self):
        """Of the window, as PNG bytes."""
        # Two frames, so that what was asked for is on the screen.
        self.call("POST", "/execute/async", {"script": "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(done));", "args": []})
        return base64.b64decode(self.call("GET", "/screenshot"))

    def messages(self):
        """Warnings and errors since the last call."""
        return [e["message"] for e in self.call("POST", "/se/log", {"type": "browser"}) if e["level"] in ("WARNING", "SEVERE")]

    def requests(self):
        """Every address that was asked for since the last call."""
        events = [json.loads(e["message"])["message"] for e in self.call("POST", "/se/log", {"type": "performance"})]
        return [e["params"]["request"]["url"] for e in events if e["method"] == "Network.requestWillBeSent"]
