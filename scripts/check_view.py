#!/usr/bin/env python3
"""Opens a page of `walpha view` in a real headless Chromium and checks what a user would see.

    scripts/check_view.py page.html [--chromium /usr/bin/chromium] [--out DIR]

From a file: URL, at the width of a desk and of a phone: no error on the console, no request to a network,
the first picture comes soon, the scene is not blank and fills its place, the legend names what is drawn in its colours, moving the slider, changing the colour and the level of detail change the picture, pointing at the
shape tells index, weight and class, points and isosurface can be shown, and nothing is wider than the screen. Leaves two screenshots.
Prints a line for each check; exits with 1 when one fails, and with 77 without Chromium.
"""

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

FLAGS = [
    "--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--use-gl=angle",
    "--use-angle=swiftshader", "--disable-gpu-sandbox", "--hide-scrollbars", "--no-first-run",
    "--disable-background-networking", "--remote-debugging-pipe",
]
# Seconds until the first picture; generous, as others may use the machine.
SOON = 20
SCREENS = {"desk": (1280, 900, False), "phone": (390, 844, True)}


class Browser:
    """Speaks the DevTools protocol over two pipes."""

    def __init__(self, chromium, profile):
        to_read, self.write_end = os.pipe()
        self.read_end, to_write = os.pipe()
        # Chromium reads commands from descriptor 3 and answers on 4.
        shell = f'exec "$@" 3<&{to_read} 4>&{to_write}'
        command = ["bash", "-c", shell, "chromium", chromium, *FLAGS, f"--user-data-dir={profile}"]
        self.process = subprocess.Popen(
            command, pass_fds=[to_read, to_write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        os.close(to_read)
        os.close(to_write)
        self.buffer, self.last, self.session, self.events = b"", 0, None, []

    def message(self):
        while b"\0" not in self.buffer:
            more = os.read(self.read_end, 1 << 20)
            if not more:
                raise RuntimeError("Chromium has gone")
            self.buffer += more
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def call(self, method, **params):
        self.last += 1
        command = {"id": self.last, "method": method, "params": params}
        if self.session:
            command["sessionId"] = self.session
        os.write(self.write_end, json.dumps(command).encode() + b"\0")
        while True:
            message = self.message()
            if message.get("id") == self.last:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']}")
                return message["result"]
            self.events.append(message)

    def attach(self):
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ["Runtime", "Log", "Page", "Network"]:
            self.call(f"{domain}.enable")

    def evaluate(self, expression):
        answer = self.call(
            "Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True
        )
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"])
        return answer["result"].get("value")

    def wait(self, expression, seconds=60):
        started = time.monotonic()
        while time.monotonic() - started < seconds:
            if self.evaluate(expression):
                return True
            time.sleep(0.05)
        return False

    def close(self):
        try:
            self.session = None
            self.call("Browser.close")
        except (RuntimeError, OSError):
            pass
        self.process.wait(timeout=20)


class Checks:
    def __init__(self):
        self.failed = 0

    def say(self, name, right, detail=""):
        self.failed += not right
        print(f"{'ok   ' if right else 'WRONG'} {name} {detail}")


def faults(events):
    """Errors on the console, exceptions, and requests that leave the machine."""
    found = []
    for event in events:
        method, params = event.get("method"), event.get("params", {})
        if method == "Runtime.exceptionThrown":
            found.append(params["exceptionDetails"].get("text", "exception"))
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "assert"):
            found.append(str([argument.get("value") for argument in params["args"]]))
        elif method == "Log.entryAdded" and params["entry"]["level"] == "error":
            found.append(params["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            url = params["request"]["url"]
            if not url.startswith(("file:", "data:", "blob:", "about:")):
                found.append(f"a request to {url}")
    return found


def picture(browser):
    """The scene as PNG, in base64."""
    box = browser.evaluate(
        "(() => { const b = document.getElementById('scene').getBoundingClientRect();"
        " return [b.x + scrollX, b.y + scrollY, b.width, b.height] })()"
    )
    clip = dict(zip(["x", "y", "width", "height"], box), scale=1)
    return browser.call("Page.captureScreenshot", format="png", clip=clip)["data"]


COLOURS = """(async () => {
  const image = await createImageBitmap(new Blob([Uint8Array.from(atob('%s'), (byte) => byte.charCodeAt(0))]));
  const canvas = new OffscreenCanvas(image.width, image.height);
  const context = canvas.getContext('2d');
  context.drawImage(image, 0, 0);
  const pixels = new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer);
  const counts = new Map();
  for (const pixel of pixels) counts.set(pixel, (counts.get(pixel) ?? 0) + 1);
  return [counts.size, 1 - Math.max(...counts.values()) / pixels.length];
})()"""


# The share of pixels that differ in two pictures by more than what a software renderer's threads leave undecided.
DIFFERENT = """(async () => {
  const pixels = await Promise.all(%s.map(async (png) => {
    const image = await createImageBitmap(new Blob([Uint8Array.from(atob(png), (byte) => byte.charCodeAt(0))]));
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, image.width, image.height).data;
  }));
  const [a, b] = pixels;
  if (a.length !== b.length) return 1;
  let different = 0;
  for (let i = 0; i < a.length; i += 4) {
    if ([0, 1, 2].some((k) => Math.abs(a[i + k] - b[i + k]) > 8)) different += 1;
  }
  return 4 * different / a.length;
})()"""


def same(browser, a, b):
    """Whether two pictures look the same."""
    return a == b or browser.evaluate(DIFFERENT % json.dumps([a, b])) < 0.001


# The share of pixels with a green that only the colours of F have.
INKED = """(async () => {
  const image = await createImageBitmap(new Blob([Uint8Array.from(atob('%s'), (byte) => byte.charCodeAt(0))]));
  const canvas = new OffscreenCanvas(image.width, image.height);
  const context = canvas.getContext('2d');
  context.drawImage(image, 0, 0);
  const pixels = context.getImageData(0, 0, image.width, image.height).data;
  let green = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    if (pixels[i + 1] > pixels[i] + 40 && pixels[i + 1] > pixels[i + 2] + 8) green += 1;
  }
  return 4 * green / pixels.length;
})()"""


# The empty rows below and above what is drawn, the legend and the colour bar aside, as shares of the picture.
EMPTY = """(async () => {
  const image = await createImageBitmap(new Blob([Uint8Array.from(atob('%s'), (byte) => byte.charCodeAt(0))]));
  const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
  context.drawImage(image, 0, 0);
  const { top, bottom } = (({ t, b, h }) => ({ top: t, bottom: t + h }))(document.getElementById('scene')._fullLayout._size);
  const inked = [];
  for (let row = Math.ceil(top); row < Math.floor(bottom); row++) {
    const pixels = new Uint32Array(context.getImageData(0, row, image.width, 1).data.buffer);
    inked.push(pixels.some((pixel) => pixel !== 0xffffffff));
  }
  return [inked.reverse().indexOf(true), inked.reverse().indexOf(true)].map((rows) => rows / image.height);
})()"""


# For each trace that can be seen: its name, its colour in the legend, whether it has an entry there, and how many of it there are.
LEGEND = """(() => {
  const scene = document.getElementById('scene');
  const entries = new Map([...scene.querySelectorAll('.legend .traces')].map((entry) => {
    const icon = entry.querySelector('.legendpoints path, .legendlines path, .legend3dandfriends');
    const style = icon && getComputedStyle(icon);
    return [entry.querySelector('.legendtext').textContent, style && (style.fill !== 'none' ? style.fill : style.stroke)];
  }));
  const traces = scene.data.map((trace) => ({
    name: trace.name, colour: trace.color ?? trace.marker?.color ?? trace.line?.color,
    drawn: trace.visible !== false && trace.x.length > 0,
  }));
  return { entries: [...entries], traces };
})()"""


def rgb(colour):
    """Red, green and blue of `#rrggbb` or `rgb(r, g, b)`."""
    if colour.startswith("#"):
        return [int(colour[k:k + 2], 16) for k in (1, 3, 5)]
    return [int(float(number)) for number in colour[colour.index("(") + 1:-1].split(",")[:3]]


def legend_faults(browser):
    """What the legend has too much, too little, or in another colour than is drawn."""
    told = browser.evaluate(LEGEND)
    entries = dict(told["entries"])
    drawn = {trace["name"]: trace["colour"] for trace in told["traces"] if trace["drawn"]}
    found = [f"{name} is not there" for name in entries.keys() - drawn.keys()]
    found += [f"{name} is not listed" for name in drawn.keys() - entries.keys()]
    if browser.evaluate("document.getElementById('colour').value") == "class":
        for name in entries.keys() & drawn.keys():
            if rgb(entries[name]) != rgb(drawn[name]):
                found.append(f"{name} is {drawn[name]} and listed as {entries[name]}")
    return found


# The numbers of a level that the page tells: name of a trace to how many there are.
TOLD = """Object.fromEntries([...document.querySelectorAll('#numbers tr')].flatMap((row) => {
  const [kind, text] = [row.children[0].textContent, row.children[1].textContent];
  if (!['facets', 'edges', 'vertices'].includes(kind)) return [];
  return text.split(', ').map((part) => [part.split(' ')[1] + ' ' + kind.replace('vertices', 'points'), Number(part.split(' ')[0])]);
}))"""


def choose(browser, colour):
    browser.evaluate(
        "(() => { const c = document.getElementById('colour'); c.value = '%s';"
        " c.dispatchEvent(new Event('change')) })()" % colour
    )
    browser.wait(f"document.getElementById('scene').dataset.colour === '{colour}'")


def detail(browser, level):
    browser.evaluate(
        "(() => { const d = document.getElementById('detail'); d.value = '%d';"
        " d.dispatchEvent(new Event('change')) })()" % level
    )
    browser.wait(f"document.getElementById('scene').dataset.detail === '{level}'")


def drawn(level):
    return f"document.getElementById('scene').dataset.level === '{level}'"


def move(browser, level):
    browser.evaluate(
        "(() => { const s = document.getElementById('level'); delete document.getElementById('scene')"
        f".dataset.level; s.value = {level}; s.dispatchEvent(new Event('input')) }})()"
    )
    return browser.wait(drawn(level))


def hover(browser):
    """What is said about the first place near the middle where something is said."""
    box = browser.evaluate(
        "(() => { const b = document.getElementById('scene').getBoundingClientRect();"
        " return [b.x + b.width / 2, b.y + b.height / 2] })()"
    )
    for step in range(12):
        place = {"x": box[0] + 9 * step - 50, "y": box[1] + 7 * step - 40}
        browser.call("Input.dispatchMouseEvent", type="mouseMoved", **place)
        time.sleep(0.4)
        said = browser.evaluate(
            "[...document.querySelectorAll('.hovertext')].map((t) => t.textContent).join(' ')"
        )
        if said:
            return said
    return ""


def look(browser, checks, page, screen, out):
    width, height, mobile = SCREENS[screen]
    browser.call(
        "Emulation.setDeviceMetricsOverride",
        width=width, height=height, deviceScaleFactor=1, mobile=mobile,
    )
    browser.events.clear()
    started = time.monotonic()
    browser.call("Page.navigate", url=pathlib.Path(page).resolve().as_uri())
    there = browser.wait("document.getElementById('scene')?.dataset.level !== undefined")
    seconds = time.monotonic() - started
    checks.say(f"{screen}: opens soon", there and seconds < SOON, f"in {seconds:.2f} s")
    if not there:
        checks.say(f"{screen}: console", False, str(faults(browser.events)))
        return
    wide = browser.evaluate("document.documentElement.scrollWidth")
    checks.say(f"{screen}: fits the width", wide <= width, f"{wide} of {width} pixels")
    first = picture(browser)
    colours, share = browser.evaluate(COLOURS % first)
    checks.say(
        f"{screen}: not blank", colours > 100 and share > 0.1,
        f"{colours} colours, {100 * share:.0f} % of the pixels not background",
    )
    below, above = browser.evaluate(EMPTY % first)
    checks.say(
        f"{screen}: nothing is empty above and below the shape", max(below, above) < 0.13,
        f"{100 * below:.0f} % of the scene below, {100 * above:.0f} % above",
    )
    whole = browser.call("Page.captureScreenshot", format="png")["data"]
    (out / f"{screen}.png").write_bytes(base64.b64decode(whole))
    last = int(browser.evaluate("document.getElementById('level').max"))
    start = int(browser.evaluate("document.getElementById('level').value"))
    other = last // 2 if start != last // 2 else last
    moved = move(browser, other)
    second = picture(browser)
    checks.say(f"{screen}: the slider changes the picture", moved and not same(browser, second, first))
    checks.say(f"{screen}: and back", move(browser, start) and same(browser, picture(browser), first))
    valued = browser.evaluate("document.querySelector('#colour option[value=value]') !== null")
    choose(browser, "class")
    checks.say(f"{screen}: only F and classes are two pictures", same(browser, picture(browser), first) != valued)
    inked = browser.evaluate(INKED % picture(browser))
    checks.say(f"{screen}: by class nothing has a colour of F", inked < 0.002, f"{100 * inked:.2f} % of the pixels")
    wrong = legend_faults(browser)
    told = browser.evaluate(TOLD)
    listed = dict(browser.evaluate(LEGEND)["entries"])
    kinds = ["regular facets", "singular facets", "singular edges", "interior points", "regular points", "singular points"]
    # What is simplified may lose all of a class.
    if browser.evaluate("document.getElementById('simplified') === null"):
        wrong += [f"{told[kind]} {kind}" for kind in kinds if (kind in listed) != (told[kind] > 0)]
    checks.say(f"{screen}: the legend is of the classes as drawn", not wrong, "; ".join(wrong) or ", ".join(listed))
    if valued:
        choose(browser, "value")
        wrong = legend_faults(browser)
        checks.say(f"{screen}: and of the colours of F", not wrong, "; ".join(wrong))
        checks.say(f"{screen}: and F is back as it was", same(browser, picture(browser), first))
        choose(browser, "class")
    if browser.evaluate("document.querySelector('#colour option[value=difference]') !== null"):
        by_class = picture(browser)
        choose(browser, "difference")
        inked = browser.evaluate(INKED % picture(browser))
        bar = browser.evaluate("document.getElementById('scene').data[0].colorbar.title.text")
        checks.say(
            f"{screen}: the difference to the original is a colour",
            inked > 0.002 and not same(browser, picture(browser), by_class) and bar.startswith("difference"),
            f"{100 * inked:.2f} % of the pixels, {bar!r}",
        )
        choose(browser, "class")
    if browser.evaluate("document.getElementById('detail') !== null"):
        detailed, shown = picture(browser), browser.evaluate("document.getElementById('detail').value")
        names, coarse = [], True
        for k in range(int(browser.evaluate("document.getElementById('detail').options.length"))):
            detail(browser, k)
            first_row = "document.querySelector('#numbers td').textContent"
            names.append(int(browser.evaluate(first_row)))
            coarse = coarse and same(browser, picture(browser), detailed) == (k == int(shown))
        checks.say(
            f"{screen}: levels of detail are pictures of their own",
            coarse and names == sorted(names), f"of {names} points",
        )
    browser.evaluate("document.getElementById('level').value = document.getElementById('level').max - 1")
    browser.evaluate("document.getElementById('play').click()")
    end = browser.wait("document.getElementById('scene').dataset.level === document.getElementById('level').max")
    checks.say(f"{screen}: play goes to the end", end)
    move(browser, start)
    before = picture(browser)
    browser.evaluate("Plotly.relayout('scene', { 'scene.camera.eye': { x: 2, y: 2, z: 0 } }).then(() => true)")
    time.sleep(2)
    turned = picture(browser)
    browser.evaluate("document.getElementById('reset').click()")
    eye = "(({ x, y, z }) => [x, y, z])(document.getElementById('scene')._fullLayout.scene.camera.eye)"
    time.sleep(2)
    checks.say(
        f"{screen}: the view can be reset", not same(browser, turned, before) and same(browser, picture(browser), before),
        str(browser.evaluate(eye)),
    )
    if not mobile:
        said = hover(browser)
        right = said.startswith("point ") and "ω = " in said
        checks.say(f"{screen}: pointing tells of a point", right, repr(said))
    for trace in ["points", "isosurface"]:
        before = picture(browser)
        shown = browser.evaluate(
            "(async () => { const s = document.getElementById('scene');"
            f" const k = s.data.findIndex((t) => t.name.includes('{trace}') && t.visible !== false);"
            " if (k < 0) return -1; await Plotly.restyle(s, { visible: true }, [k]); return k })()"
        )
        if shown >= 0:
            # Filled only now.
            number = {"points": 3, "isosurface": 6}[trace]
            browser.wait(f"document.getElementById('scene').dataset.shown.includes('{number}')")
            checks.say(f"{screen}: {trace} can be shown", not same(browser, picture(browser), before))
    with tempfile.TemporaryDirectory() as folder:
        browser.call("Page.setDownloadBehavior", behavior="allow", downloadPath=folder)
        browser.evaluate("document.getElementById('save').click()")
        ended = time.monotonic() + SOON
        while not (saved := list(pathlib.Path(folder).glob("*.png"))) and time.monotonic() < ended:
            time.sleep(0.2)
        head = saved[0].read_bytes()[:8] if saved else b""
        checks.say(f"{screen}: the picture can be saved", head == b"\x89PNG\r\n\x1a\n", "".join(path.name for path in saved))
    found = faults(browser.events)
    checks.say(f"{screen}: console and network are quiet", not found, "; ".join(found))
    blocked = browser.evaluate(
        "new Promise((say) => { addEventListener('securitypolicyviolation', (event) => say(event.effectiveDirective), { once: true });"
        " fetch('data:,').catch(() => setTimeout(() => say('not'), 1000)) })"
    )
    checks.say(f"{screen}: nothing can be fetched", blocked == "connect-src", f"({blocked} blocked)")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("page")
    parser.add_argument("--chromium", default="/usr/bin/chromium")
    parser.add_argument("--out", default=".", type=pathlib.Path)
    options = parser.parse_args()
    if shutil.which(options.chromium) is None:
        print(f"skipped: there is no {options.chromium}")
        sys.exit(77)
    options.out.mkdir(parents=True, exist_ok=True)
    checks = Checks()
    size = pathlib.Path(options.page).stat().st_size
    checks.say("size", size < 15e6, f"{size / 1e6:.1f} MB")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(options.chromium, profile)
        try:
            browser.attach()
            for screen in SCREENS:
                look(browser, checks, options.page, screen, options.out)
        finally:
            browser.close()
    sys.exit(min(checks.failed, 1))


if __name__ == "__main__":
    main()
