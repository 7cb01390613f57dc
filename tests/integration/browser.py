"""A headless Chromium, told what to do through a pipe (Chrome DevTools Protocol)."""

import base64
import itertools
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

CHROMIUM = shutil.which("chromium")
KEYS = {"Enter": 13, "Escape": 27, "Tab": 9, " ": 32, "ArrowLeft": 37, "ArrowUp": 38,
        "ArrowRight": 39, "ArrowDown": 40, "Home": 36, "End": 35, "PageDown": 34}
SHIFT = 8
PATIENCE = 300  # seconds; a busy machine draws a large page in many


class Browser:
    """One window without a network, drawn without a graphics card; for a `with` statement."""

    def __init__(self, *options):
        self.options = options
        self.numbers = itertools.count(1)
        self.buffer = b""
        self.complaints = []

    def __enter__(self):
        self.profile = tempfile.mkdtemp(prefix="bccskel-browser-")
        command_in, self.command_out = os.pipe()
        self.reply_in, reply_out = os.pipe()

        self.process = subprocess.Popen(
            # It reads from 3 and writes to 4.
            ["sh", "-c", f'exec "$@" 3<&{command_in} 4>&{reply_out}', "sh",
             CHROMIUM, "--headless=new", "--no-sandbox", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--webgl-antialiasing-mode=none",
             "--host-resolver-rules=MAP * ~NOTFOUND",
             "--user-data-dir=" + self.profile, "--remote-debugging-pipe", "--no-first-run",
             *self.options, "about:blank"],
            pass_fds=(command_in, reply_out), stderr=subprocess.DEVNULL)
        os.close(command_in)
        os.close(reply_out)
        page = next(t for t in self.send("Target.getTargets", session=None)["targetInfos"]
                    if t["type"] == "page")
        self.session = self.send("Target.attachToTarget", session=None, flatten=True,
                                 targetId=page["targetId"])["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.send(domain + ".enable")
        self.resize(1200, 800)
        return self

    def __exit__(self, *_):
        self.send("Browser.close", session=None)
        try:
            self.process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.command_out)
        os.close(self.reply_in)
        shutil.rmtree(self.profile, ignore_errors=True)

    def receive(self):
        deadline = time.monotonic() + PATIENCE
        while b"\0" not in self.buffer:
            ready, _, _ = select.select([self.reply_in], [], [], deadline - time.monotonic())
            part = os.read(self.reply_in, 1 << 20) if ready else b""
            if not part:
                raise AssertionError("the browser does not answer")
            self.buffer += part
        message, _, self.buffer = self.buffer.partition(b"\0")
        return json.loads(message)

    def send(self, method, session="", **parameters):
        number = next(self.numbers)
        message = {"id": number, "method": method, "params": parameters}
        if session is not None:
            message["sessionId"] = self.session
        os.write(self.command_out, json.dumps(message).encode() + b"\0")
        while True:
            reply = self.receive()
            if reply.get("id") == number:
                if "error" in reply:
                    raise AssertionError(f"{method}: {reply['error']}")
                return reply["result"]
            self.note(reply)

    def note(self, event):
        told = event.get("params", {})
        if event.get("method") == "Runtime.exceptionThrown":
            self.complaints.append(told["exceptionDetails"].get("exception", {}).get("description"))
        if event.get("method") == "Log.entryAdded":
            self.complaints.append(told["entry"]["text"])
        if event.get("method") == "Runtime.consoleAPICalled":
            self.complaints.append(str([a.get("value") for a in told["args"]]))

    def open(self, path, address=""):
        """A page of bccskel, until it is ready or says that it failed."""
        self.complaints.clear()
        self.send("Page.navigate", url="about:blank")  # another address alone loads nothing
        self.send("Page.navigate", url=f"file://{path}{address}")
        self.wait("['ready', 'failed'].includes(document.documentElement?.dataset.state)")

    def follow(self, address):
        """A link to the page that is open, which needs no loading."""
        self.run(f"new Promise((done) => {{ addEventListener('hashchange', done); "
                 f"location.hash = {json.dumps(address)}; }})")

    def run(self, script):
        """The value of an expression in the page."""
        reply = self.send("Runtime.evaluate", expression=script, returnByValue=True,
                          awaitPromise=True)
        if "exceptionDetails" in reply:
            raise AssertionError(reply["exceptionDetails"]["exception"].get("description"))
        return reply["result"].get("value")

    def wait(self, condition):
        deadline = time.monotonic() + PATIENCE
        while not self.run(condition):
            if time.monotonic() > deadline:
                raise AssertionError("never: " + condition)
            time.sleep(0.05)

    def settle(self):
        """Until what was asked for has been drawn."""
        self.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        self.wait("!gliding && !asked")

    def resize(self, width, height, scale=0.5):
        """In CSS pixels. Drawing without a graphics card takes most of the time of a test, so
        the canvas has fewer pixels unless a test counts them."""
        self.send("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=scale, mobile=False)

    def prefer(self, **features):
        """Media features, such as color_scheme="dark"."""
        self.send("Emulation.setEmulatedMedia", features=[
            {"name": "prefers-" + name.replace("_", "-"), "value": value}
            for name, value in features.items()])

    def move(self, x, y, buttons=0):
        self.send("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y, buttons=buttons)

    def press(self, x, y, modifiers=0):
        """A click."""
        self.move(x, y)
        for kind in ("mousePressed", "mouseReleased"):
            self.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1,
                      modifiers=modifiers)

    def drag(self, *places, button="left"):
        mask = {"left": 1, "right": 2}[button]
        (x, y), (last_x, last_y) = places[0], places[-1]
        self.move(x, y)
        self.send("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, button=button,
                  buttons=mask, clickCount=1)
        for place in places[1:]:
            self.move(*place, buttons=mask)
        self.send("Input.dispatchMouseEvent", type="mouseReleased", x=last_x, y=last_y,
                  button=button, clickCount=1)

    def scroll(self, x, y, by):
        self.send("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=by)

    def click(self, selector):
        """On the middle of an element, which must be what lies there."""
        x, y, hit = self.run(f"""(() => {{
          const e = document.querySelector({json.dumps(selector)});
          e.scrollIntoView({{ block: "nearest" }});
          const b = e.getBoundingClientRect(), x = b.x + b.width / 2, y = b.y + b.height / 2;
          const top = document.elementFromPoint(x, y);
          return [x, y, !!top && (e.contains(top) || top.contains(e))];
        }})()""")
        if not hit:
            raise AssertionError(f"{selector} is covered or not there")
        self.press(x, y)

    def key(self, *names, modifiers=0):
        for name in names:
            code = KEYS.get(name, ord(name[0].upper()))
            text = {"Enter": "\r"}.get(name, name if len(name) == 1 else "")
            for kind in ("keyDown", "keyUp"):
                self.send("Input.dispatchKeyEvent", type=kind, key=name, modifiers=modifiers,
                          windowsVirtualKeyCode=code, text=text if kind == "keyDown" else "")

    def type(self, text):
        self.send("Input.insertText", text=text)

    def text(self, selector):
        return self.run(f"document.querySelector({json.dumps(selector)}).textContent")

    def picture(self):
        """As PNG, with all pixels: pictures of a movement may have fewer."""
        self.wait("!gliding && !asked && !pace.coarse")
        return base64.b64decode(self.send("Page.captureScreenshot", format="png")["data"])
