#!/usr/bin/env python3
"""Opens a page of `walpha view` in a real headless Chromium and checks what a user would see.

    scripts/check_view.py page.html [--chromium /usr/bin/chromium] [--out DIR]

From a file: URL, at the width of a desk and of a phone: no error on the console, no request to a network, the first picture comes soon, the
scene is not blank and fills its place, in the material of walpha's pictures or by height, drawers open and are remembered, the legend names what is drawn in its colours, moving the slider, changing the colour and the level
of detail change the picture, a click on the shape tells index, weight and class, a cut, points, balls and isosurface can be shown, voids light up,
and nothing is wider than the screen. Leaves two screenshots.
Prints a line for each check; exits with 1 when one fails, and with 77 without Chromium.
"""

import argparse
import base64
import json
import os
import pathlib
import re
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
# The second finds the drawers open that the first has left open.
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


# What axe-core finds, as it is kept beside the page's sources by npm; it is a tool for this alone.
AXE = pathlib.Path(__file__).parent.parent / "web/page/node_modules/axe-core/axe.min.js"
# Text is readable from this contrast on (WCAG 1.4.3).
READABLE = 4.5


def accessible(browser, checks, state):
    """Nothing is wrong with the page for those who use it with other means, as axe-core sees it."""
    if not AXE.exists():
        print("skipped: there is no axe-core (npm ci in web/page)")
        return
    browser.evaluate(AXE.read_text() + "; null")
    found = browser.evaluate("axe.run().then(({ violations }) => violations.map(({ id, nodes }) => [id, nodes.map(({ html }) => html.slice(0, 90))]))")
    checks.say(f"{state}: axe-core finds nothing", not found, str(found) if found else "")


def luminance(colour):
    """The relative luminance of #rgb or #rrggbb."""
    digits = colour.lstrip("#")
    digits = digits if len(digits) == 6 else "".join(2 * digit for digit in digits)
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in (int(digits[k:k + 2], 16) / 255 for k in (0, 2, 4))]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    low, high = sorted([luminance(one), luminance(other)])
    return (high + 0.05) / (low + 0.05)


def readable_charts(checks):
    """The text of charts, which are drawn on canvases where axe-core sees nothing, stands out from the page."""
    sources = pathlib.Path(__file__).parent.parent / "web/page"
    charts, style = (sources / "charts.js").read_text(), (sources / "page.css").read_text()
    back, text = (re.search(rf"--{name}: light-dark\((#\w+), (#\w+)\)", style).groups() for name in ("back", "text"))
    for k, name in enumerate(["ON_LIGHT", "ON_DARK"]):
        colours = re.findall(r"#\w{6}", re.search(rf"{name} = \[(.*?)\]", charts)[1])
        least = min(contrast(colour, back[k]) for colour in [*colours, text[k]])
        checks.say(f"the text of charts is readable, {name}", len(colours) == 3 and least >= READABLE, f"{least:.1f} : 1")


def faults(events):
    """Errors on the console, exceptions, and requests that leave the machine."""
    found = []
    for event in events:
        method, params = event.get("method"), event.get("params", {})
        if method == "Runtime.exceptionThrown":
            found.append(params["exceptionDetails"].get("text", "exception"))
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "assert"):
            found.append(str([argument.get("value", argument.get("description")) for argument in params["args"]]))
        elif method == "Log.entryAdded" and params["entry"]["level"] == "error":
            found.append(params["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            url = params["request"]["url"]
            if not url.startswith(("file:", "data:", "blob:", "about:")):
                found.append(f"a request to {url}")
    return found


def picture(browser):
    """The scene as PNG, in base64."""
    # What is scrolled out of sight may not be drawn. Without captions the scene may be larger: it is drawn coarsely, then at rest.
    browser.evaluate("scrollTo({ top: 0, behavior: 'instant' })")
    browser.evaluate(BARE % "true")
    settle(browser)
    settle(browser)
    box = browser.evaluate(
        "(() => { const b = document.getElementById('scene').getBoundingClientRect();"
        " return [b.x + scrollX, b.y + scrollY, b.width, b.height] })()"
    )
    clip = dict(zip(["x", "y", "width", "height"], box), scale=1)
    data = browser.call("Page.captureScreenshot", format="png", clip=clip)["data"]
    browser.evaluate(BARE % "false")
    settle(browser)
    settle(browser)
    return data


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


# The empty rows and columns below, above, right and left of what is drawn, as shares of the picture; captions lie on its left.
EMPTY = """(async () => {
  const image = await createImageBitmap(new Blob([Uint8Array.from(atob('%s'), (byte) => byte.charCodeAt(0))]));
  const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, image.width, image.height);
  const pixels = new Uint32Array(data.buffer);
  const [rows, columns] = [new Array(image.height).fill(false), new Array(image.width).fill(false)];
  pixels.forEach((pixel, k) => {
    if (pixel === 0xffffffff) return;
    rows[Math.floor(k / image.width)] = true;
    columns[k %% image.width] = true;
  });
  const ends = (inked) => [inked.toReversed().indexOf(true), inked.indexOf(true)].map((count) => count / inked.length);
  return [...ends(rows), ...ends(columns)];
})()"""
# Captions lie on the picture, and are not part of it.
BARE = "['captions', 'axes'].forEach((id) => document.getElementById(id).toggleAttribute('hidden', %s))"


# The entries of the legend: what, how many, in which colour.
LEGEND = """[...document.querySelectorAll('#legend span')].map((entry) => {
  const [, count, name] = /^(\\d+) (.*)$/.exec(entry.textContent.replaceAll('\u202f', '')) ?? [null, null, entry.textContent];
  return [name, Number(count), getComputedStyle(entry.querySelector('i')).backgroundColor];
})"""
# How a class is drawn: red, green and blue of the facets and edges.
COLOUR_OF = {
    "regular facets": (0, 114, 178), "singular facets": (213, 94, 0), "singular edges": (230, 159, 0),
    "interior points": (0, 158, 115), "regular points": (0, 114, 178), "singular points": (213, 94, 0),
}
# Counts of a level as the page's table has them, by the names of the legend.
TOLD = """Object.fromEntries([...document.querySelectorAll('#measures tr')].flatMap((row) => {
  const [kind, text] = [row.children[0].textContent, row.children[1].textContent.replaceAll('\u202f', '')];
  if (!['facets', 'edges', 'vertices'].includes(kind)) return [];
  return text.split(', ').map((part) => [part.split(' ')[1] + ' ' + kind.replace('vertices', 'points'), Number(part.split(' ')[0])]);
}))"""
# The share of pixels whose hue is that of a colour.
HUED = """(async () => {
  const image = await createImageBitmap(new Blob([Uint8Array.from(atob('%s'), (byte) => byte.charCodeAt(0))]));
  const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, image.width, image.height);
  const hue = (r, g, b) => Math.atan2(Math.sqrt(3) * (g - b), 2 * r - g - b);
  const wanted = hue(...%s);
  let found = 0;
  for (let i = 0; i < data.length; i += 4) {
    const [r, g, b] = data.subarray(i, i + 3);
    if (Math.max(r, g, b) - Math.min(r, g, b) > 60 && Math.abs(hue(r, g, b) - wanted) < 0.15) found += 1;
  }
  return 4 * found / data.length;
})()"""
# The share of pixels that are not background, and as yellow as bone in any light.
HUED_LIKE_BONE = """(async () => {
  const image = await createImageBitmap(new Blob([Uint8Array.from(atob('%s'), (byte) => byte.charCodeAt(0))]));
  const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, image.width, image.height);
  let found = 0;
  for (let i = 0; i < data.length; i += 4) {
    const [r, g, b] = data.subarray(i, i + 3);
    if (r > g && g > b && r - b > 8 && r - b < 60) found += 1;
  }
  return 4 * found / data.length;
})()"""
# The share of pixels that are the face of a cut, which no lamp shades: beside the material, or of the class interior.
FACE = """(async () => {
  const image = await createImageBitmap(new Blob([Uint8Array.from(atob('%s'), (byte) => byte.charCodeAt(0))]));
  const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, image.width, image.height);
  const faces = [[0xb9, 0xa5, 0x8c], [0x00, 0x9e, 0x73]];
  let found = 0;
  for (let i = 0; i < data.length; i += 4) {
    if (faces.some((face) => face.every((x, k) => Math.abs(data[i + k] - x) < 2))) found += 1;
  }
  return 4 * found / data.length;
})()"""
# Targets that a finger may miss; a label is one with its box.
SMALL = """[...document.querySelectorAll('button, input, select')].filter((e) => e.checkVisibility()).map((e) =>
  [e.id || e.textContent, Math.round((e.closest('label') ?? e).getBoundingClientRect().height)]).filter(([, height]) => height < 44)"""
# The numbers are those of the α that is shown.
RESTED = "document.body.dataset.measured !== undefined && document.body.dataset.measured === document.body.dataset.alpha"


def legend_faults(browser, exact):
    """What the legend has too much, too little, in another colour or number than is drawn."""
    entries = {name: (count, colour) for name, count, colour in browser.evaluate(LEGEND)}
    told = browser.evaluate(TOLD)
    image = picture(browser)
    # Points are listed where they are drawn.
    kinds = [kind for kind in COLOUR_OF if kind.split()[1] != "points" or browser.evaluate("document.getElementById('show-points').checked")]
    wrong = [f"{name} is not a class" for name in entries if name not in kinds]
    for kind in kinds:
        count, colour = entries.get(kind, (0, None))
        # What is simplified may lose some of a class.
        if exact and count != told[kind]:
            wrong.append(f"{count} {kind}, and {told[kind]} in the table")
        if colour and rgb(colour) != COLOUR_OF[kind]:
            wrong.append(f"{kind} are listed as {colour}")
        if colour and kind == "regular facets" and browser.evaluate(HUED % (image, list(COLOUR_OF[kind]))) < 0.02:
            wrong.append(f"no pixel has the colour of {kind}")
    return wrong


def rgb(colour):
    """Red, green and blue of `rgb(r, g, b)`."""
    return tuple(int(float(number)) for number in colour[colour.index("(") + 1:-1].split(",")[:3])


def settle(browser):
    """Waits until nothing is left to draw."""
    browser.wait(f"document.body.dataset.moving === undefined && {RESTED}")
    browser.evaluate("new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(() => resolve(true))))")


def change(browser, identifier, value, event="change"):
    """Sets a control as a user does."""
    browser.evaluate(
        "(() => { const e = document.getElementById('%s'); e.value = %s; e.dispatchEvent(new Event('%s')); })()"
        % (identifier, json.dumps(value), event)
    )
    settle(browser)


def press(browser, identifier):
    browser.evaluate(f"document.getElementById('{identifier}').click()")
    settle(browser)


def move(browser, share):
    """Moves the slider."""
    browser.evaluate("delete document.body.dataset.measured")
    change(browser, "alpha", share, "input")
    return browser.evaluate("document.body.dataset.alpha")


def point_at(browser, how):
    """What is said of the first place near the middle where something is said, when it is clicked or pointed at."""
    browser.evaluate("document.getElementById('scene').scrollIntoView({ block: 'center' })")
    x, y = browser.evaluate(
        "(() => { const b = document.getElementById('scene').getBoundingClientRect();"
        " return [b.x + b.width / 2, b.y + b.height / 2] })()"
    )
    said = ""
    for step in range(12):
        place = {"x": x + 9 * step - 50, "y": y + 7 * step - 40}
        if how == "a click":
            for kind in ["mousePressed", "mouseReleased"]:
                browser.call("Input.dispatchMouseEvent", type=kind, button="left", clickCount=1, **place)
        else:
            browser.call("Input.dispatchMouseEvent", type="mouseMoved", **place)
            time.sleep(0.4)
        said = browser.evaluate("document.getElementById('picked').textContent")
        if said:
            break
    browser.evaluate("scrollTo(0, 0); document.getElementById('picked').textContent = ''")
    return said


def look(browser, checks, page, screen, out):
    width, height, mobile = SCREENS[screen]
    browser.call(
        "Emulation.setDeviceMetricsOverride",
        width=width, height=height, deviceScaleFactor=1, mobile=mobile,
    )
    browser.events.clear()
    started = time.monotonic()
    browser.call("Page.navigate", url=pathlib.Path(page).resolve().as_uri())
    there = browser.wait("document.body?.dataset.frame !== undefined && document.body.dataset.looked !== undefined")
    seconds = time.monotonic() - started
    checks.say(f"{screen}: opens soon", there and seconds < SOON, f"in {seconds:.2f} s")
    if not there or not browser.wait(f"document.body.dataset.state === 'ready' && {RESTED}"):
        checks.say(f"{screen}: console", False, str(faults(browser.events)))
        return
    settle(browser)
    controls = browser.evaluate("[...document.querySelectorAll('button, input, select')].filter((e) => e.checkVisibility() && e.closest('footer, .drawer') === null).length")
    before = browser.evaluate("[...document.querySelectorAll('.drawer')].filter((drawer) => drawer.checkVisibility()).length")
    checks.say(f"{screen}: drawers are as they were left", (before > 0) == (screen == "phone"), f"{before} open")
    checks.say(f"{screen}: at most 12 controls before a drawer is opened", controls <= 12, str(controls))
    accessible(browser, checks, screen)
    if mobile:
        small = browser.evaluate(SMALL)
        checks.say(f"{screen}: every target is 44 pixels high", not small, str(small))
        top = browser.evaluate("document.getElementById('scene').getBoundingClientRect().top")
        checks.say(f"{screen}: the picture comes first", top < 120, f"at {top:.0f} pixels")
    numbers = browser.evaluate("document.getElementById('summary').textContent")
    checks.say(f"{screen}: the numbers that matter are in a line", all(word in numbers for word in ["Volume", "surface", "part", "void"]), numbers)
    material = browser.evaluate("document.getElementById('colour').value")
    tinted = browser.evaluate(HUED_LIKE_BONE % picture(browser))
    checks.say(f"{screen}: opens in the material of pictures, or by height", material == "height" or (material == "plain" and tinted > 0.05), f"{material}, {100 * tinted:.0f} % of the pixels")
    # Drawers stay open from here on, so that the picture keeps its size.
    browser.evaluate("document.querySelectorAll('[data-drawer]').forEach((button) => button.ariaExpanded === 'true' || button.click())")
    settle(browser)
    accessible(browser, checks, f"{screen}, with drawers")
    there = browser.evaluate("[...document.querySelectorAll('.drawer')].filter((drawer) => drawer.checkVisibility()).map((drawer) => drawer.id)")
    checks.say(f"{screen}: drawers open", set(there) >= {"display", "numbers"}, str(there))
    change(browser, "colour", "class")
    if not browser.evaluate("document.getElementById('show-singular').checked"):
        press(browser, "show-singular")
    wide = browser.evaluate("document.documentElement.scrollWidth")
    checks.say(f"{screen}: fits the width", wide <= width, f"{wide} of {width} pixels")
    first = picture(browser)
    colours, share = browser.evaluate(COLOURS % first)
    checks.say(
        f"{screen}: not blank", colours > 100 and share > 0.1,
        f"{colours} colours, {100 * share:.0f} % of the pixels not background",
    )
    below, above, right, left = browser.evaluate(EMPTY % first)
    checks.say(
        f"{screen}: the shape fills the height or the width of its place", min(max(below, above), max(right, left)) < 0.08,
        f"{100 * below:.0f} % empty below, {100 * above:.0f} % above, {100 * right:.0f} % right, {100 * left:.0f} % left",
    )
    whole = browser.call("Page.captureScreenshot", format="png")["data"]
    (out / f"{screen}.png").write_bytes(base64.b64decode(whole))
    start = browser.evaluate("document.getElementById('alpha').value")
    opened = browser.evaluate("document.body.dataset.alpha")
    moved = move(browser, 0.5 if abs(float(start) - 0.5) > 0.1 else 1)
    second = picture(browser)
    checks.say(f"{screen}: the slider changes the picture", moved != opened and not same(browser, second, first), f"{opened} to {moved}")
    checks.say(f"{screen}: and back", move(browser, start) == opened and same(browser, picture(browser), first))
    inked = browser.evaluate(INKED % first)
    checks.say(f"{screen}: by class nothing has a colour of F", inked < 0.002, f"{100 * inked:.2f} % of the pixels")
    # Of a simplified picture the page says so.
    exact = not browser.evaluate("document.getElementById('remarks').textContent.includes('simplified')")
    wrong = legend_faults(browser, exact)
    checks.say(f"{screen}: the legend is of the classes as drawn", not wrong, "; ".join(wrong) or str(browser.evaluate(LEGEND)))
    for by, name in [("value", "F ("), ("difference", "difference"), ("weight", "ω")]:
        if browser.evaluate(f"document.querySelector('#colour option[value={by}]').hidden"):
            continue
        change(browser, "colour", by)
        inked = browser.evaluate(INKED % picture(browser))
        title = browser.evaluate("document.getElementById('legend').textContent")
        # Weights may all be one, and values few.
        right = (inked > 0.002 or by != "difference") and not same(browser, picture(browser), first) and title.startswith(name)
        checks.say(f"{screen}: {by} is a colour", right, f"{100 * inked:.2f} % of the pixels, {title!r}")
        change(browser, "colour", "class")
        checks.say(f"{screen}: and classes are back as they were", same(browser, picture(browser), first))
    if not browser.evaluate("document.getElementById('detail-label').hidden"):
        shown = browser.evaluate("document.getElementById('detail').value")
        names, coarse = [], True
        for k in range(int(browser.evaluate("document.getElementById('detail').options.length"))):
            browser.evaluate("delete document.body.dataset.measured")
            change(browser, "detail", str(k))
            names.append(int(browser.evaluate("[...document.querySelectorAll('#measures tr')].find((row) => row.children[0].textContent === 'points').children[1].textContent.replaceAll('\u202f', '')")))
            coarse = coarse and same(browser, picture(browser), first) == (k == int(shown))
        checks.say(
            f"{screen}: levels of detail are pictures of their own",
            coarse and names == sorted(names), f"of {names} points",
        )
    move(browser, 0.8)
    browser.evaluate("document.getElementById('play').click()")
    end = browser.wait("document.getElementById('play').textContent === 'Play' && document.getElementById('alpha').value === '1'")
    checks.say(f"{screen}: play goes to the end", end)
    move(browser, start)
    many = sum(count for name, count, _ in browser.evaluate(LEGEND) if name.endswith("facets")) > 50000
    for key in ["ArrowLeft", "ArrowLeft", "+"]:
        browser.evaluate(f"document.getElementById('scene').dispatchEvent(new KeyboardEvent('keydown', {{ key: '{key}' }}))")
        browser.evaluate("new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(() => resolve(true))))")
        # It is measured with the first of these.
        if many:
            browser.wait("document.body.dataset.slow !== undefined", 10)
    settle(browser)
    # Most browsers without a graphics card are slow.
    if many:
        slow = browser.evaluate("document.body.dataset.slow") == "true"
        coarse, last = browser.evaluate("[document.body.dataset.coarse !== undefined, document.body.dataset.drawn]")
        checks.say(f"{screen}: many triangles are turned coarsely where that is slow, and drawn whole at rest", coarse == slow and last == "whole", f"slow: {slow}, coarse: {coarse}, then {last}")
    turned = picture(browser)
    press(browser, "home")
    checks.say(
        f"{screen}: the view can be reset", not same(browser, turned, first) and same(browser, picture(browser), first),
    )
    for how in ["a click"] if mobile else ["pointing", "a click"]:
        said = point_at(browser, how)
        checks.say(f"{screen}: {how} tells of a point", said.startswith("point ") and "ω = " in said, repr(said))
    for name in ["points", "balls", "original", "box", "singular"]:
        if browser.evaluate(f"document.getElementById('show-{name}').parentElement.hidden"):
            continue
        press(browser, f"show-{name}")
        there = not same(browser, picture(browser), first)
        if name == "singular":
            there = there or all(count == 0 for kind, count in browser.evaluate(TOLD).items() if kind in ("singular facets", "singular edges"))
        if name == "points":
            wrong = legend_faults(browser, exact)
            checks.say(f"{screen}: the legend names points", not wrong, "; ".join(wrong))
        if name == "box":
            said = browser.evaluate("[...document.querySelectorAll('.labels span')].map((e) => e.textContent)")
            there = there and [text[:2] for text in said] == ["x:", "y:", "z:"]
        press(browser, f"show-{name}")
        checks.say(f"{screen}: {name} can be shown or hidden", there and same(browser, picture(browser), first))
    change(browser, "cut", "1")
    open_shape = picture(browser)
    checks.say(f"{screen}: a plane cuts the shape open", not same(browser, open_shape, first))
    face = browser.evaluate(FACE % open_shape)
    is_solid = browser.evaluate(TOLD).get("regular facets", 0) > 0
    checks.say(f"{screen}: where it is solid, the cut has a face", (face > 0.002) == is_solid, f"{100 * face:.2f} %")
    change(browser, "cut", "")
    checks.say(f"{screen}: and it is whole again", same(browser, picture(browser), first))
    if browser.evaluate("document.querySelector('#voids button') !== null"):
        browser.evaluate("document.querySelector('#voids button').focus()")
        settle(browser)
        lit = picture(browser)
        filled = browser.evaluate(HUED % (lit, [213, 94, 0]))
        browser.evaluate("document.querySelector('#voids button').blur()")
        checks.say(f"{screen}: a void is filled, in the faded shape", not same(browser, lit, first) and filled > 0.0005, f"{100 * filled:.2f} % of the pixels")
    # What was changed is undone, and done again.
    opened = browser.evaluate("document.body.dataset.alpha")
    move(browser, 0.3)
    moved = browser.evaluate("document.body.dataset.alpha")
    press_keys = "dispatchEvent(new KeyboardEvent('keydown', { key: 'z', ctrlKey: true, shiftKey: %s }))"
    for keys, expected, name in [("false", opened, "undone"), ("true", moved, "done again"), ("false", opened, "undone once more")]:
        browser.evaluate("delete document.body.dataset.measured")
        browser.evaluate(press_keys % keys)
        there = browser.wait(f"document.body.dataset.alpha === '{expected}'", 10)
        settle(browser)
        checks.say(f"{screen}: a change of the radius is {name}", there and opened != moved, browser.evaluate("document.body.dataset.alpha"))
    # Two places on the surface have a distance.
    press(browser, "measure")
    x, y = browser.evaluate("(() => { const e = document.getElementById('scene'); e.scrollIntoView({ block: 'center' }); const b = e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2] })()")
    said = ""
    for step in range(16):
        for kind in ["mousePressed", "mouseReleased"]:
            browser.call("Input.dispatchMouseEvent", type=kind, button="left", clickCount=1, x=x + 11 * step - 70, y=y + 9 * step - 60)
        said = browser.evaluate("document.getElementById('picked').textContent")
        if said.startswith("Length"):
            break
    unit = browser.evaluate("document.getElementById('bar').textContent").split(" ")[-1]
    settle(browser)
    checks.say(f"{screen}: two places are measured", said.startswith("Length ") and said.endswith(unit), said)
    press(browser, "measure")
    letters = browser.evaluate("[...document.querySelectorAll('#axes text')].map((e) => e.textContent).join('')")
    checks.say(f"{screen}: the axes have letters", letters in ("LRPASI", "xyz"), letters)
    browser.evaluate("scrollTo(0, 0)")
    with tempfile.TemporaryDirectory() as folder:
        browser.call("Page.setDownloadBehavior", behavior="allow", downloadPath=folder)
        browser.evaluate("document.getElementById('save-png').click()")
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
    readable_charts(checks)
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
