#!/usr/bin/python3
"""The customer's page by keyboard and as a screen reader has it, in headless Chromium by its DevTools protocol.

usage: drive_page.py PAGE.html [--pictures DIR [--at ADDRESS ...]]
With --at nothing but pictures of the body as the page shows it at each address (PAGE.html#ADDRESS): DIR/0.png, DIR/1.png, ...
Else, at 390 and 1280 pixels: the mouse reads off, turns and zooms; every control is reached by Tab in the order of the page, with a focus
that can be seen; WebGL is lost and comes back; slider, boxes, buttons and the body answer to keys; roles, names and tables of the
accessibility tree; nothing is requested but the page. Once
more without WebGL. Prints what it met and the time of the first picture; ends with 1 where something is wrong."""
import argparse
import base64
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

SOFTWARE_GL = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
NO_WEBGL = ["--disable-gpu", "--disable-webgl", "--disable-3d-apis", "--disable-software-rasterizer"]
KEYS = {"Tab": 9, "Enter": 13, " ": 32, "End": 35, "Home": 36, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40}
CONTROLS = "button:not(:disabled), input, canvas, a[href]"
WAIT = 60  # s at most for an answer


class Browser:
    """Headless Chromium with one page; speaks the protocol over pipes."""

    def __init__(self, options):
        self.profile = tempfile.mkdtemp(prefix="tensegric_fit_page_")
        to_read, self.to = os.pipe()
        self.answers, to_write = os.pipe()
        command = ["chromium", "--headless=new", "--no-sandbox", "--remote-debugging-pipe", f"--user-data-dir={self.profile}",
                   "--no-first-run", *options, "about:blank"]
        self.process = subprocess.Popen(["bash", "-c", f'exec "$@" 3<&{to_read} 4>&{to_write}', "bash", *command],
                                        pass_fds=[to_read, to_write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(to_write)
        self.number, self.session, self.rest, self.events = 0, None, b"", []
        page = next(target for target in self.ask("Target.getTargets")["targetInfos"] if target["type"] == "page")
        self.session = self.ask("Target.attachToTarget", targetId=page["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Network", "Runtime", "Accessibility"):
            self.ask(domain + ".enable")

    def close(self):
        try:
            self.session = None
            self.ask("Browser.close")
            self.process.wait(WAIT)
        finally:
            self.process.kill()
            shutil.rmtree(self.profile, ignore_errors=True)

    def message(self):
        while b"\0" not in self.rest:
            part = os.read(self.answers, 1 << 20)
            if not part:
                raise RuntimeError("Chromium has ended")
            self.rest += part
        line, self.rest = self.rest.split(b"\0", 1)
        return json.loads(line)

    def ask(self, method, **parameters):
        self.number += 1
        question = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            question["sessionId"] = self.session
        os.write(self.to, json.dumps(question).encode() + b"\0")
        while True:
            answer = self.message()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self.events.append(answer)

    def run(self, script):
        answer = self.ask("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{script}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def becomes_true(self, script):
        """Whether it does, in time."""
        end = time.monotonic() + WAIT
        while time.monotonic() < end:
            if self.run(script):
                return True
            time.sleep(0.1)
        return False

    def open(self, page, width, height, address=""):
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.ask("Page.navigate", url=page.resolve().as_uri() + (f"#{address}" if address else ""))
        if not self.becomes_true("location.protocol === 'file:' && document.readyState === 'complete' && (!document.body.classList."
                                 "contains('turns') || document.getElementById('canvas').dataset.drawn !== undefined)"):
            raise RuntimeError("the page was not there in time")

    def press(self, key):
        text = {"Enter": "\r", " ": " "}.get(key, "")
        known = {"key": key, "code": "Space" if key == " " else key, "windowsVirtualKeyCode": KEYS.get(key, ord(key[0]))}
        if len(key) == 1 and key != " ":
            text = key
            known.pop("code")
        self.ask("Input.dispatchKeyEvent", type="keyDown" if text else "rawKeyDown", text=text, **known)
        self.ask("Input.dispatchKeyEvent", type="keyUp", **known)

    def picture(self, element=None):
        """PNG of the window, or of an element."""
        parameters = {}
        if element:
            box = self.run(f"(b => ({{x: b.x + scrollX, y: b.y + scrollY, width: b.width, height: b.height, scale: 1}}))"
                           f"(document.querySelector('{element}').getBoundingClientRect())")
            parameters = {"clip": box, "captureBeyondViewport": True}
        return base64.b64decode(self.ask("Page.captureScreenshot", format="png", **parameters)["data"])

    def still_picture(self, element):
        """The same, once two in a row are alike."""
        end, before = time.monotonic() + WAIT, b""
        while time.monotonic() < end:
            now = self.picture(element)
            if now == before:
                return now
            before = now
        raise RuntimeError(f"{element} does not stand still")

    def tree(self):
        """Of what a screen reader has: role, name, node of each that is not ignored."""
        nodes = self.ask("Accessibility.getFullAXTree")["nodes"]
        return [{"role": node["role"]["value"], "name": node.get("name", {}).get("value", ""), "id": node["nodeId"],
                 "children": node.get("childIds", []), "focusable": is_focusable(node), "all": node}
                for node in nodes if not node.get("ignored") and "role" in node]

    def requested(self):
        self.run("0")
        return [event["params"]["request"]["url"] for event in self.events if event.get("method") == "Network.requestWillBeSent"]


def is_focusable(node):
    return any(entry["name"] == "focusable" and entry["value"].get("value") for entry in node.get("properties", []))


FOCUS = """(() => {
  const at = document.activeElement, box = at.getBoundingClientRect(), style = getComputedStyle(at);
  return {place: [...document.querySelectorAll('%s')].filter(e => e.getClientRects().length).indexOf(at),
          outline: style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) >= 2,
          inside: box.bottom > 0 && box.top < innerHeight && box.right > 0 && box.left < innerWidth,
          what: at.tagName.toLowerCase() + ' ' + (at.id || at.dataset.loop || at.dataset.look || '')};
})()""" % CONTROLS


class Page:
    def __init__(self, browser, where):
        self.browser, self.where, self.faults = browser, where, []

    def expect(self, holds, what):
        if not holds:
            self.faults.append(f"{self.where}: {what}")
            print("FAULT", self.faults[-1], flush=True)

    def tabs(self):
        """Through all controls, from the start of the page."""
        count = self.browser.run(f"[...document.querySelectorAll('{CONTROLS}')].filter(e => e.getClientRects().length).length")
        met = []
        for place in range(count):
            self.browser.press("Tab")
            focus = self.browser.run(FOCUS)
            met.append(focus["what"].strip())
            self.expect(focus["place"] == place, f"Tab {place + 1} reaches {focus['what']}, control {focus['place'] + 1}")
            self.expect(focus["outline"], f"the focus of {focus['what']} cannot be seen")
            self.expect(focus["inside"], f"{focus['what']} has the focus outside the window")
        print(f"{self.where}: Tab: {', '.join(met)}", flush=True)
        return count

    def focus(self, selector):
        self.browser.run(f"document.querySelector('{selector}').focus()")

    def slider(self):
        values = []
        self.focus("#share")
        for key in ("End", "ArrowLeft", "ArrowLeft", "Home", "ArrowRight"):
            self.browser.press(key)
            values.append(self.browser.run("document.getElementById('share').valueAsNumber"))
        self.expect(values == [100, 99, 98, 0, 1], f"the slider by keys: {values}")
        said = self.browser.run("document.getElementById('share').getAttribute('aria-valuetext')")
        self.expect(said.startswith("1 %"), f"the slider says {said}")

    def changes(self, what, selector, key):
        """Whether a key on a control changes the picture of the body."""
        before = self.browser.picture("#canvas")
        self.focus(selector)
        self.browser.press(key)
        self.expect(self.browser.picture("#canvas") != before, f"{what} by key: the picture does not change")

    def keys(self):
        self.browser.press("End")
        self.slider()
        self.changes("slider", "#share", "End")
        for look in ("left", "back", "right", "front"):
            self.changes(look, f"[data-look={look}]", "Enter")
        for box in ("colours", "lines", "close", "beside"):
            self.changes(box, f"#{box}", " ")
            if box in ("beside", "lines"):
                self.browser.press(" ")
        for key in ("ArrowLeft", "ArrowUp", "+", "-"):
            self.changes(key + " on the body", "#canvas", key)
        self.focus("[data-loop]")
        self.browser.press("Enter")
        self.expect(self.browser.run("document.querySelector('[data-loop]').getAttribute('aria-pressed')") == "true",
                    "a measure chosen by Enter is not said to be pressed")

    def by_mouse(self):
        """What the mouse does: the value under it, turning by dragging, zoom by the wheel."""
        self.browser.run("document.querySelector('#canvas').scrollIntoView({block: 'center'})")
        x, y = self.browser.run("(b => [b.x + b.width / 2, b.y + b.height / 2])(document.getElementById('canvas').getBoundingClientRect())")
        mouse = lambda kind, right=0, **more: self.browser.ask("Input.dispatchMouseEvent", type=kind, x=x + right, y=y, **more)
        mouse("mouseMoved")
        said = self.browser.run("document.getElementById('reading').textContent")
        self.expect(said, "nothing is read off under the mouse")
        before = self.browser.picture("#canvas")
        mouse("mousePressed", button="left", clickCount=1)
        mouse("mouseMoved", 60, button="left", buttons=1)
        mouse("mouseReleased", 60, button="left", clickCount=1)
        turned = self.browser.picture("#canvas")
        self.expect(turned != before, "dragging does not turn the body")
        mouse("mouseWheel", deltaX=0, deltaY=-200)
        self.expect(self.browser.picture("#canvas") != turned, "the wheel does not zoom")
        print(f"{self.where}: under the mouse: {said}", flush=True)

    def context_lost(self):
        """A browser may take WebGL from a page, and give it back. No picture is taken meanwhile: that would have the page drawn."""
        self.browser.run("""(() => {
          const gl = document.getElementById('canvas').drawn_by, draw = gl.drawElements;
          window.drawn = 0;
          gl.drawElements = function () { ++drawn; draw.apply(gl, arguments); };
          gl.canvas.addEventListener('webglcontextlost', () => { window.gone = true; });
          window.taken = gl.getExtension('WEBGL_lose_context');
          taken.loseContext();
        })()""")
        # the browser says so to the page when it is idle
        self.expect(self.browser.becomes_true("window.gone === true"), "the page does not hear that WebGL is lost")
        self.browser.run("drawn = 0; taken.restoreContext()")
        self.expect(self.browser.becomes_true("drawn > 0"), "the body is not drawn again after WebGL came back")

    def reads(self, turns):
        """What a screen reader has."""
        nodes = self.browser.tree()
        by_id = {node["id"]: node for node in nodes}
        roles = {}
        for node in nodes:
            roles.setdefault(node["role"], []).append(node)
            if node["focusable"] and node["role"] != "RootWebArea":
                self.expect(node["name"].strip(), f"a control without a name: {node['role']}")
        shown = ("main", "heading", "table", "columnheader", "rowheader", "cell", "image", "application", "slider", "checkbox",
                 "button")
        counts = {role: len(roles.get(role, [])) for role in shown}
        print(f"{self.where}: {counts}", flush=True)
        for table in roles.get("table", []):
            self.expect(table["name"].strip(), "a table without a name")
        rows = [[by_id[child]["role"] for child in row["children"] if child in by_id] for row in roles.get("row", [])]
        heads = [row for row in rows if set(row) == {"columnheader"}]
        self.expect(len(heads) == len(roles.get("table", [])), "a table without a row of column headers")
        for row in rows:
            if row not in heads:
                self.expect(row[0] == "rowheader" and set(row[1:]) == {"cell"}, f"a row is read as {row}")
        for image in roles.get("image", []):
            self.expect(image["name"].strip(), "a picture without words")
        self.expect(counts["main"] == 1, "no main part")
        for role, count in {"application": 1, "slider": 1, "checkbox": 4}.items():
            self.expect(counts[role] == (count if turns else 0), f"{counts[role]} of role {role}")
        return nodes


def drive(page, options, width, turns, pictures):
    browser = Browser(options)
    try:
        at = Page(browser, f"{width} px{'' if turns else ', no WebGL'}")
        browser.run("!!document.createElement('canvas').getContext('webgl')")  # hers runs when she opens the page
        browser.open(page, width, 900)
        at.expect(browser.run("document.body.classList.contains('turns')") == turns, "3D where there is none, or none where there is")
        if turns:
            print(f"{at.where}: first picture after {browser.run('document.getElementById(`canvas`).dataset.drawn')} ms", flush=True)
        at.reads(turns)
        count = at.tabs()
        if pictures:
            name = f"{width}{'' if turns else '_no_webgl'}"
            (pictures / f"focus_{name}.png").write_bytes(browser.picture())
            browser.run("scrollTo(0, 0)")
            (pictures / f"{name}.png").write_bytes(browser.picture("body"))
        if turns:
            at.context_lost()
            at.by_mouse()
            at.keys()
            if pictures:
                browser.run("document.querySelector('.only3d').scrollIntoView()")
                (pictures / f"keys_{name}.png").write_bytes(browser.picture())
        else:
            at.expect(count == 0, f"{count} controls that do nothing")
            shown = browser.run("[...document.images].filter(i => i.complete && i.naturalWidth && i.getClientRects().length).length")
            at.expect(shown >= 3, f"{shown} pictures")
        others = [url[:80] for url in browser.requested() if not url.startswith(("data:", "blob:", page.resolve().as_uri(), "about:"))]
        at.expect(not others, f"requested: {others}")
        at.expect(browser.run("document.documentElement.scrollWidth <= innerWidth"), "wider than the window")
        return at.faults
    finally:
        browser.close()


def show(page, addresses, pictures):
    browser = Browser(SOFTWARE_GL)
    try:
        for number, address in enumerate(addresses):
            browser.ask("Page.navigate", url="about:blank")  # another address of the same page would not be read
            browser.open(page, 390, 900, address)
            if not browser.run("document.body.classList.contains('turns')"):
                raise RuntimeError("no 3D")
            (pictures / f"{number}.png").write_bytes(browser.still_picture("#canvas"))
    finally:
        browser.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--pictures", type=pathlib.Path, help="folder for pictures of what was seen")
    parser.add_argument("--at", action="append", metavar="ADDRESS", help="what follows # in the page's address; may be repeated")
    arguments = parser.parse_args()
    if arguments.at and not arguments.pictures:
        parser.error("--at needs --pictures")
    if arguments.pictures:
        arguments.pictures.mkdir(parents=True, exist_ok=True)
    if arguments.at:
        show(arguments.page, arguments.at, arguments.pictures)
        return
    faults = []
    for width in (390, 1280):
        faults += drive(arguments.page, SOFTWARE_GL, width, True, arguments.pictures)
    faults += drive(arguments.page, NO_WEBGL, 390, False, arguments.pictures)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
