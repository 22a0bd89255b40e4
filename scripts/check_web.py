#!/usr/bin/env python3
"""Opens walpha.html in a real headless Chromium and, where there is one, Firefox, and compares what it makes with the command.

    scripts/check_web.py walpha.html target/release/walpha [--large] [--out DIR]

Files of each kind are chosen as a user would; for each the page's counts, Betti numbers and saved files are those of the command that
the page prints, byte for byte. Besides: no error on the console, no request to a network, what cannot be read is refused in the
command's words, work can be cancelled, what is clicked, dropped and shown on request, a phantom in time, nothing wider than a phone. Leaves screenshots
in DIR. Prints a line for each check; exits with 1 when one fails, and with 77 without Chromium.
"""

import argparse
import base64
import gzip
import json
import math
import pathlib
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import time

from check_view import Browser, Checks, accessible, faults

SIZE = 20
SCREENS = {"desk": (1400, 950, False), "phone": (390, 844, True)}


def values():
    """A hollow ball in Hounsfield units, x fastest."""
    samples = []
    for z in range(SIZE):
        for y in range(SIZE):
            for x in range(SIZE):
                radius = math.dist((x, y, z), (9.5, 9.2, 9.7))
                samples.append(1000 if 5 <= radius < 8 else 40 if radius < 5 else -1000)
    return samples


def dicom(folder, samples):
    """A series of slices: explicit VR, little endian."""

    def element(group, number, kind, value):
        value = value if isinstance(value, bytes) else str(value).encode()
        value += (b"\0" if kind in ("UI", "OB") else b" ") * (len(value) % 2)
        if kind in ("OB", "OW"):
            return struct.pack("<HH2sHI", group, number, kind.encode(), 0, len(value)) + value
        return struct.pack("<HH2sH", group, number, kind.encode(), len(value)) + value

    def short(number):
        return struct.pack("<H", number)

    folder.mkdir()
    for z in range(SIZE):
        uid = f"1.2.3.4.{z + 1}"
        meta = element(2, 1, "OB", b"\0\1") + element(2, 2, "UI", "1.2.840.10008.5.1.4.1.1.2") + element(2, 3, "UI", uid)
        meta += element(2, 0x10, "UI", "1.2.840.10008.1.2.1") + element(2, 0x12, "UI", "1.2.3.4")
        data = element(8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2") + element(8, 0x18, "UI", uid) + element(8, 0x60, "CS", "CT")
        data += element(0x20, 0xD, "UI", "1.2.3") + element(0x20, 0xE, "UI", "1.2.3.5") + element(0x20, 0x13, "IS", z + 1)
        data += element(0x20, 0x32, "DS", f"-10\\-10\\{2 * z}") + element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0")
        data += element(0x28, 2, "US", short(1)) + element(0x28, 4, "CS", "MONOCHROME2") + element(0x28, 0x10, "US", short(SIZE))
        data += element(0x28, 0x11, "US", short(SIZE)) + element(0x28, 0x30, "DS", "1\\1") + element(0x28, 0x100, "US", short(16))
        data += element(0x28, 0x101, "US", short(16)) + element(0x28, 0x102, "US", short(15)) + element(0x28, 0x103, "US", short(1))
        data += element(0x28, 0x1052, "DS", "0") + element(0x28, 0x1053, "DS", "1")
        slice_ = samples[z * SIZE * SIZE:(z + 1) * SIZE * SIZE]
        data += element(0x7FE0, 0x10, "OW", struct.pack(f"<{SIZE * SIZE}h", *slice_))
        whole = b"\0" * 128 + b"DICM" + element(2, 0, "UL", struct.pack("<I", len(meta))) + meta + data
        (folder / f"slice{z:03}.dcm").write_bytes(whole)


def las(points):
    """LAS 1.2, points of format 0, in millimetres."""
    header = bytearray(227)
    header[0:4] = b"LASF"
    header[24:26] = bytes([1, 2])
    struct.pack_into("<HIIBHI", header, 94, 227, 227, 0, 0, 20, len(points))
    struct.pack_into("<6d", header, 131, 0.001, 0.001, 0.001, 0, 0, 0)
    bounds = [f(p[k] for p in points) for k in range(3) for f in (max, min)]
    struct.pack_into("<6d", header, 179, *bounds)
    body = b"".join(struct.pack("<3iH4BH", *(round(1000 * x) for x in p), 7, 0, 2, 0, 0, 0) for p in points)
    return bytes(header) + body


def tiff(samples):
    """A stack of pages of 16-bit samples, from 0 on."""
    pages, offset, whole = [], 8, b""
    for z in range(SIZE):
        data = struct.pack(f"<{SIZE * SIZE}H", *(max(0, s + 1000) for s in samples[z * SIZE * SIZE:(z + 1) * SIZE * SIZE]))
        tags = [(256, 3, SIZE), (257, 3, SIZE), (258, 3, 16), (259, 3, 1), (262, 3, 1), (273, 4, offset), (277, 3, 1), (278, 3, SIZE), (279, 4, len(data))]
        after = offset + len(data) + 2 + 12 * len(tags) + 4
        directory = struct.pack("<H", len(tags)) + b"".join(struct.pack("<HHII", tag, kind, 1, value) for tag, kind, value in tags)
        pages.append(offset + len(data))
        whole += data + directory + struct.pack("<I", after + len(data) if z + 1 < SIZE else 0)
        offset = after
    return struct.pack("<2sHI", b"II", 42, pages[0]) + whole


def make_files(folder):
    """One file of each kind, and what kind it is."""
    samples = values()
    raw = struct.pack(f"<{len(samples)}h", *samples)
    header = bytearray(352)
    struct.pack_into("<I", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, SIZE, SIZE, SIZE, 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, 4, 16)
    struct.pack_into("<8f", header, 76, 1, 1, 1, 2, 0, 0, 0, 0)
    struct.pack_into("<3f", header, 108, 352, 1, 0)
    header[123] = 2
    struct.pack_into("<h", header, 254, 1)
    struct.pack_into("<12f", header, 280, 1, 0, 0, -10, 0, 1, 0, -10, 0, 0, 2, 0)
    header[344:348] = b"n+1\0"
    (folder / "ball.nii.gz").write_bytes(gzip.compress(bytes(header) + raw))
    nrrd = f"NRRD0004\ntype: int16\ndimension: 3\nsizes: {SIZE} {SIZE} {SIZE}\nspacings: 1 1 2\nendian: little\nencoding: raw\n\n"
    (folder / "ball.nrrd").write_bytes(nrrd.encode() + raw)
    mha = f"ObjectType = Image\nNDims = 3\nDimSize = {SIZE} {SIZE} {SIZE}\nElementType = MET_SHORT\nElementByteOrderMSB = False\nElementSpacing = 1 1 2\n"
    (folder / "ball.mha").write_bytes(mha.encode() + b"ElementDataFile = LOCAL\n" + raw)
    (folder / "two.mhd").write_bytes(mha.encode() + b"ElementDataFile = two.raw\n")
    (folder / "two.raw").write_bytes(raw)
    description = f"{{'descr': '<i2', 'fortran_order': False, 'shape': ({SIZE}, {SIZE}, {SIZE}), }}".ljust(117) + "\n"
    # Two labels, one around the other.
    marks = bytes((value > 300) + (value > 700) for value in samples)
    (folder / "labels.nrrd").write_bytes(nrrd.replace("int16", "uint8").encode() + marks)
    (folder / "ball.npy").write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(description)) + description.encode() + raw)
    (folder / "ball.tif").write_bytes(tiff(samples))
    dicom(folder / "series", samples)
    points = []
    for k in range(400):
        z = 1 - 2 * (k + 0.5) / 400
        turn, flat = 2.399963 * k, math.sqrt(1 - z * z)
        points.append((round(flat * math.cos(turn), 3), round(flat * math.sin(turn), 3), round(z, 3)))
    lines = [" ".join(map(str, p)) for p in points]
    (folder / "ball.xyz").write_text("\n".join(lines) + "\n")
    (folder / "it's a ball.csv").write_text("x,y,z,weight\n" + "\n".join(line.replace(" ", ",") + ",0.001" for line in lines) + "\n")
    (folder / "ball.obj").write_text("".join(f"v {line}\n" for line in lines))
    (folder / "cloud.ply").write_text(f"ply\nformat ascii 1.0\nelement vertex {len(points)}\nproperty double x\nproperty double y\nproperty double z\nend_header\n" + "\n".join(lines) + "\n")
    facets = "".join(f"facet normal 0 0 0\nouter loop\nvertex {lines[k]}\nvertex {lines[k + 1]}\nvertex {lines[k + 2]}\nendloop\nendfacet\n" for k in range(0, 396, 3))
    (folder / "ball.stl").write_text(f"solid ball\n{facets}endsolid ball\n")
    (folder / "ball.las").write_bytes(las(points))
    # An oxygen lattice in a slanted cell, with a silicon atom in each.
    atoms = "Si 0.1 0.2 0.3\nO 1.2 0.4 0.5\nO 0.3 1.6 0.2\nO 1.9 1.4 1.5\n"
    # A lattice three times: of equal points one is kept, and its weight hides others.
    lattice = [f"{k % 5},{k // 5 % 5},{k // 25},{weight}\n" for weight in (0, 0.25, 0.25) for k in range(125)]
    (folder / "duplicates.csv").write_text("x,y,z,weight\n" + "".join(lattice))
    (folder / "crystal.xyz").write_text(f'4\nLattice="2.5 0 0 1.25 2.25 0 0.5 0.75 2.5" Properties=species:S:1:pos:R:3 pbc="T T T"\n{atoms}')
    return [
        "ball.nii.gz", "ball.nrrd", "ball.mha", "two.mhd", "ball.npy", "ball.tif", "series",
        "ball.xyz", "it's a ball.csv", "ball.obj", "cloud.ply", "ball.stl", "ball.las",
    ]


def large_file(path, size=420):
    """A ball in more samples than a page works on."""
    with path.open("wb") as out:
        out.write(f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {size} {size} {size}\nencoding: raw\n\n".encode())
        for z in range(size):
            for y in range(size):
                square = (0.4 * size) ** 2 - (z - size / 2) ** 2 - (y - size / 2) ** 2
                width = 2 * round(math.sqrt(max(0, square)))
                out.write((b"\xc8" * width).center(size, b"\0"))


def huge_file(path, size=1024):
    """Zeros, a few megabytes when compressed, that take more memory than a page has."""
    header = struct.pack("<I36x8h", 348, 3, size, size, size, 1, 1, 1, 1) + struct.pack("<14x2h2x8f", 2, 8, 1, 1, 1, 1, 0, 0, 0, 0)
    header = header.ljust(108, b"\0") + struct.pack("<f", 352)
    header = header.ljust(344, b"\0") + b"n+1\0\0\0\0\0"
    with gzip.open(path, "wb", compresslevel=1) as out:
        out.write(header)
        for _ in range(size):
            out.write(bytes(size * size))


class Firefox:
    """Speaks the Marionette protocol: lengths and JSON over a socket."""

    def __init__(self, program, profile):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        preferences = {"marionette.port": port, "browser.shell.checkDefaultBrowser": False, "datareporting.policy.dataSubmissionEnabled": False, "webgl.force-enabled": True}
        text = "".join(f'user_pref("{name}", {json.dumps(value)});\n' for name, value in preferences.items())
        pathlib.Path(profile, "user.js").write_text(text)
        command = [program, "--headless", "--marionette", "--no-remote", "--profile", profile]
        self.process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for _ in range(300):
            try:
                self.socket = socket.create_connection(("127.0.0.1", port))
                break
            except OSError:
                time.sleep(0.1)
        self.stream, self.last = self.socket.makefile("rb"), 0
        self.message()
        self.call("WebDriver:NewSession", capabilities={})
        self.call("WebDriver:SetTimeouts", script=120000)

    def message(self):
        length = b""
        while (byte := self.stream.read(1)) != b":":
            if not byte:
                raise RuntimeError("Firefox has gone")
            length += byte
        return json.loads(self.stream.read(int(length)))

    def call(self, command, **parameters):
        self.last += 1
        text = json.dumps([0, self.last, command, parameters]).encode()
        self.socket.sendall(str(len(text)).encode() + b":" + text)
        _, _, error, result = self.message()
        if error:
            raise RuntimeError(f"{command}: {error['message']}")
        return result

    def evaluate(self, expression):
        return self.call("WebDriver:ExecuteScript", script=f"return ({expression})", args=[])["value"]

    wait = Browser.wait

    def open(self, url):
        self.call("WebDriver:Navigate", url=url)

    def screenshot(self):
        return base64.b64decode(self.call("WebDriver:TakeScreenshot", full=False)["value"])

    def choose(self, control, paths):
        element = self.call("WebDriver:FindElement", using="css selector", value=f"#{control}")["value"]
        self.call("WebDriver:ElementSendKeys", id=next(iter(element.values())), text="\n".join(map(str, paths)))

    def close(self):
        try:
            self.call("Marionette:Quit", flags=["eForceQuit"])
        except (RuntimeError, OSError, ValueError):
            pass
        self.process.wait(timeout=20)


class Chromium(Browser):
    def hear_workers(self):
        """From now on, events of the page's workers are heard, too."""
        self.call("Target.setAutoAttach", autoAttach=True, waitForDebuggerOnStart=False, flatten=True)
        self.evaluate("1")
        page = self.session
        for event in list(self.events):
            if event.get("method") == "Target.attachedToTarget" and event["params"]["targetInfo"]["type"] == "worker":
                self.session = event["params"]["sessionId"]
                for domain in ["Runtime", "Network"]:
                    self.call(f"{domain}.enable")
        self.session = page

    def open(self, url):
        self.call("Page.navigate", url=url)

    def screenshot(self):
        return base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])

    def choose(self, control, paths):
        node = self.call("Runtime.evaluate", expression=f"document.getElementById('{control}')")["result"]["objectId"]
        self.call("DOM.setFileInputFiles", files=[str(path) for path in paths], objectId=node)


SETTLED = "['ready', 'failed', 'cancelled'].includes(document.body.dataset.state)"
# The picture of the shape alone, without what is around it.
SCENE = "document.querySelector('#scene canvas').toDataURL()"
MEASURED = "document.body.dataset.state === 'failed' || document.body.dataset.measured === document.body.dataset.alpha && document.body.dataset.alpha"


class Page:
    """The page in one of the browsers."""

    def __init__(self, browser, folder, walpha):
        self.browser, self.folder, self.walpha = browser, folder, walpha

    def text(self, identifier):
        return self.browser.evaluate(f"document.getElementById('{identifier}').textContent")

    def forget(self):
        self.browser.evaluate("(() => { for (const key of ['looked', 'alpha', 'measured', 'saved']) delete document.body.dataset[key]; document.body.dataset.state = 'busy'; })()")

    def example(self, name):
        self.forget()
        self.browser.evaluate(f"(() => {{ const e = document.getElementById('examples'); e.value = '{name}'; e.dispatchEvent(new Event('change')); }})()")

    def choose(self, name):
        self.forget()
        path = self.folder / name
        if path.is_dir():
            self.browser.choose("folder", [path])
        elif name == "two.mhd":
            self.browser.choose("files", [path, self.folder / "two.raw"])
        else:
            self.browser.choose("files", [path])

    def drawer(self, name):
        """Opens a drawer."""
        self.browser.evaluate(f"(() => {{ const button = document.querySelector('[data-drawer={name}]'); if (button.ariaExpanded !== 'true') button.click(); }})()")

    def settled(self, seconds=120):
        return self.browser.wait(SETTLED, seconds) and self.browser.wait(MEASURED, seconds)

    def state(self):
        return self.browser.evaluate("({...document.body.dataset})")

    def run(self, command):
        """The printed command, by this program."""
        shell = command.replace("walpha ", f"'{self.walpha}' ", 1)
        done = subprocess.run(shell, shell=True, cwd=self.folder, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"{command}: {done.stderr}")
        return done.stdout


def click(browser, x, y):
    for kind in ["mousePressed", "mouseReleased"]:
        browser.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)


def agrees(page, checks, name):
    """What the page shows is what its command reports."""
    if not page.settled() or page.state()["state"] != "ready":
        checks.say(f"{name} is read", False, page.text("failure") or page.text("status"))
        return False
    # Where nothing is in the shape, the page says so, and the command needs to be told to go on.
    report = json.loads(page.run(f"{page.text('command')} --json --allow-empty"))["shape"]
    state = page.state()
    theirs = (",".join(map(str, report["betti"])), str(report["cells"]["interior"]))
    checks.say(f"{name}: Betti numbers and cells are the command's", (state["betti"], state["cells"]) == theirs, f"{state['betti']}, {state['cells']} cells; {theirs}")
    return True


def saved(page, checks, downloads, extension):
    """A saved file is the command's, byte for byte."""
    page.browser.evaluate("delete document.body.dataset.saved")
    page.browser.evaluate(f"document.getElementById('save-{extension}').click()")
    page.browser.wait("document.body.dataset.saved", 60)
    name = page.state().get("saved")
    path = downloads / name
    for _ in range(100):
        if path.exists():
            break
        time.sleep(0.1)
    page.run(page.text("command"))
    same = path.exists() and path.read_bytes() == (page.folder / name).read_bytes()
    checks.say(f"{name}: the command writes the same bytes", same, f"{path.stat().st_size if path.exists() else 0} bytes")
    for one in [path, page.folder / name]:
        one.unlink(missing_ok=True)


def look_at_all(browser, page, checks, files, downloads, out, large):
    """All checks, in Chromium."""
    # Without a file, there are examples to press, and nothing that cannot be used.
    (out / "web-empty.png").write_bytes(browser.screenshot())
    cards, controls = browser.evaluate("[document.querySelectorAll('#cards button').length, [...document.querySelectorAll('button, input, select')].filter((e) => e.checkVisibility() && !e.closest('#cards, footer')).map((e) => e.id)]")
    checks.say("the empty page has three examples, and controls for files alone", (cards, controls) == (3, ["choose", "choose-folder", "examples"]), f"{cards}, {controls}")
    accessible(browser, checks, "empty")
    page.forget()
    browser.evaluate("document.querySelector('#cards button').click()")
    if agrees(page, checks, "the first example"):
        checks.say("and the examples are gone", not browser.evaluate("document.getElementById('drop').checkVisibility()"))
    for name in files:
        page.choose(name)
        if agrees(page, checks, name):
            saved(page, checks, downloads, "ply")
    page.choose("ball.nii.gz")
    page.settled()
    for extension in ["stl", "glb", "vtu", "npz", "csv", "wvm"]:
        saved(page, checks, downloads, extension)
    # The recipe, as a file, does the same.
    browser.evaluate("document.getElementById('save-ply').click()")
    browser.wait("document.body.dataset.saved === 'ball.ply'", 30)
    browser.evaluate("document.getElementById('save-toml').click()")
    toml = downloads / "recipe.toml"
    for _ in range(50):
        if toml.exists():
            break
        time.sleep(0.1)
    shutil.copy(toml, page.folder)
    page.run(toml.read_text().splitlines()[0].removeprefix("# "))
    same = (page.folder / "ball.ply").read_bytes() == (downloads / "ball.ply").read_bytes()
    checks.say("the recipe as a file gives the same bytes", same)

    # The solid of labels, all or one, which has no α.
    page.choose("labels.nrrd")
    agrees(page, checks, "labels")
    checks.say("labels have no slider over α", browser.evaluate("document.getElementById('alpha-row').hidden"))
    saved(page, checks, downloads, "stl")
    page.forget()
    browser.evaluate("(() => { document.getElementById('labels').value = '2'; document.getElementById('options').requestSubmit(); })()")
    agrees(page, checks, "one of the labels")
    page.choose("ball.nii.gz")
    page.settled()

    # A radius is taken as it is, too, and α is its square.
    page.forget()
    browser.evaluate("(() => { const e = document.getElementById('radius-value'); e.value = '1.5'; document.body.dataset.state = 'ready'; e.dispatchEvent(new Event('change')); })()")
    if agrees(page, checks, "a ball radius of 1.5"):
        checks.say("α is the square of the radius", page.state()["alpha"] == "2.25", page.state()["alpha"])
    # α: the slider moves among stops, a number is taken as it is.
    for alpha in ["3.7", "0.3"]:
        page.forget()
        browser.evaluate(f"(() => {{ const e = document.getElementById('alpha-value'); e.value = {alpha}; document.body.dataset.state = 'ready'; e.dispatchEvent(new Event('change')); }})()")
        agrees(page, checks, f"α = {alpha}")
    for alpha, words in [("0.1", "Only points are in the shape"), ("-5", "Nothing is in the shape")]:
        page.forget()
        browser.evaluate(f"(() => {{ const e = document.getElementById('alpha-value'); e.value = {alpha}; document.body.dataset.state = 'ready'; e.dispatchEvent(new Event('change')); }})()")
        browser.wait(MEASURED, 60)
        checks.say(f"α = {alpha}: the legend says that there is no surface", words in page.text("legend"), page.text("legend"))
    for share in [0.2, 0.55, 0.9]:
        page.forget()
        browser.evaluate(f"(() => {{ const e = document.getElementById('alpha'); e.value = {share}; document.body.dataset.state = 'ready'; e.dispatchEvent(new Event('input')); }})()")
        agrees(page, checks, f"slider at {share}")

    # Of a CT the command would select bone; with other options stated it does not.
    browser.evaluate("(() => { const e = document.getElementById('preset'); e.value = ''; e.dispatchEvent(new Event('change')); document.getElementById('options').requestSubmit(); for (const key of ['alpha', 'measured']) delete document.body.dataset[key]; })()")
    agrees(page, checks, "a CT without a preset")
    # After an error, what was wrong is corrected.
    page.forget()
    browser.evaluate("(() => { document.getElementById('frame').value = 99; document.getElementById('options').requestSubmit(); })()")
    checks.say("a volume that is not there is an error", browser.wait("document.body.dataset.state === 'failed'", 20), page.text("failure"))
    page.forget()
    browser.evaluate("(() => { document.getElementById('frame').value = ''; document.getElementById('options').requestSubmit(); })()")
    agrees(page, checks, "after an error")

    # Weights are frozen at the α that they are proportional to: another α is one of a ladder.
    browser.evaluate("(() => { document.getElementById('weights').value = 'min-max'; document.getElementById('options').requestSubmit(); delete document.body.dataset.measured; document.body.dataset.state = 'busy'; })()")
    agrees(page, checks, "weights min-max")
    page.forget()
    browser.evaluate("(() => { const e = document.getElementById('alpha-value'); e.value = 1.5; document.body.dataset.state = 'ready'; e.dispatchEvent(new Event('change')); })()")
    page.settled()
    page.run(page.text("command"))
    rows = (page.folder / "ladder" / "ladder.json")
    level = json.loads(rows.read_text())["levels"][0]
    state = page.state()
    checks.say("another α with frozen weights is one of a ladder", state["betti"] == ",".join(map(str, level["betti"])) and state["cells"] == str(level["cells"]))

    # The diagram pairs what the command pairs.
    page.choose("ball.xyz")
    page.settled()
    opened = float(page.state()["alpha"])
    page.drawer("numbers")
    browser.evaluate("document.getElementById('compute-diagram').click()")
    browser.wait("document.body.dataset.pairs", 60)
    page.run("walpha filtration ball.xyz -o pairs.csv")
    theirs = [0, 0, 0]
    for line in (page.folder / "pairs.csv").read_text().splitlines()[1:]:
        theirs[int(line.split(",")[0])] += 1
    checks.say("the diagram has the command's pairs", page.state()["pairs"] == ",".join(map(str, theirs)), f"{page.state()['pairs']}; {theirs}")

    # A click on a pair sets α between its birth and its death.
    voids = [line.split(",") for line in (page.folder / "pairs.csv").read_text().splitlines() if line.startswith("2,")]
    browser.evaluate("document.getElementById('diagram').scrollIntoView()")
    # There is one void, green as nothing else is.
    spot = browser.evaluate("""(() => {
      const canvas = document.getElementById('diagram');
      const b = canvas.getBoundingClientRect();
      const { data, width, height } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      const scale = canvas.width / b.width;
      for (let y = Math.round(20 * scale); y < height; y++) for (let x = 0; x < width; x++) {
        const [r, g, blue] = data.subarray(4 * (y * width + x), 4 * (y * width + x) + 3);
        if (r < 60 && g > 100 && g > blue + 15) return [b.x + x / scale, b.y + y / scale + 1];
      }
      return [b.x, b.y];
    })()""")
    click(browser, *spot)
    time.sleep(1)
    alpha = float(page.state()["alpha"])
    there = [float(birth) <= alpha < float(death) for _, birth, death, *_ in voids]
    checks.say("a click on a pair sets α", there == [True] and alpha != opened, f"{alpha}; {voids}")

    # It also draws the cycle of the pair, until Escape.
    drawn = browser.wait("document.body.dataset.cycle !== undefined && document.getElementById('picked').textContent.startsWith('void, ')", 20)
    faces = int((page.state().get("cycle") or "0,0").split(",")[1]) // 3
    checks.say("and draws the void", drawn and faces >= 4, f"{faces} triangles; {page.text('picked')}")
    with_cycle = browser.evaluate(SCENE)
    (out / "web-cycle.png").write_bytes(browser.screenshot())
    browser.evaluate("dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape' }))")
    time.sleep(0.5)
    checks.say("and Escape hides it", browser.evaluate(SCENE) != with_cycle and page.text("picked") == "")

    # A molecule is its atoms, in the colours of their elements, and its balls are measured as the command does.
    page.example("sample:peptide")
    page.settled()
    for probe in ["0", "1.4"]:
        browser.evaluate(f"(() => {{ delete document.body.dataset.balls; const e = document.getElementById('probe'); e.value = '{probe}'; e.dispatchEvent(new Event('change')); }})()")
        browser.wait("document.body.dataset.balls !== undefined", 30)
        theirs = json.loads(page.run(page.text("balls-command") + " --json"))["balls"]
        volume, area = (float(number) for number in page.state()["balls"].split(","))
        near = abs(volume - theirs["volume"]) <= theirs["volume_bound"] and abs(area - theirs["area"]) <= theirs["area_bound"]
        checks.say(f"balls with a probe of {probe} are the command's", near, f"{volume}, {area}; {page.text('balls-command')}")
    named = page.text("legend")
    checks.say("elements are named in their colours", browser.evaluate("document.getElementById('colour').value") == "element" and all(f" {symbol}" in named for symbol in "CNO"), named)
    (out / "web-molecule.png").write_bytes(browser.screenshot())

    # A crystal repeats in the cell of its file, and in a box.
    page.choose("crystal.xyz")
    page.settled()
    in_space = page.state().get("betti")
    for repeats, box in [("cell", ""), ("box", "4,4,4:xy")]:
        page.forget()
        browser.evaluate(f"(() => {{ for (const [id, value] of [['periodic', '{repeats}'], ['box', '{box}']]) {{ const e = document.getElementById(id); e.value = value; e.dispatchEvent(new Event('change')); }} document.getElementById('options').requestSubmit(); }})()")
        name = f"a crystal, {repeats} {box}"
        agrees(page, checks, name)
        checks.say(f"{name}: it is another shape than in space", page.state().get("betti") != in_space, page.state().get("betti"))
        # Between two stops other copies are needed than at these.
        for radius in ["1.3", "100", "1.31"]:
            page.forget()
            browser.evaluate(f"(() => {{ const e = document.getElementById('radius-value'); e.value = '{radius}'; document.body.dataset.state = 'ready'; e.dispatchEvent(new Event('change')); }})()")
            agrees(page, checks, f"{name}, radius {radius}")
        whole = browser.evaluate(SCENE)
        browser.evaluate("(() => { const e = document.getElementById('cut'); e.value = '2'; e.dispatchEvent(new Event('change')); })()")
        time.sleep(0.7)
        checks.say(f"{name}: it is cut", browser.evaluate(SCENE) != whole)
        (out / f"web-crystal-{repeats}.png").write_bytes(browser.screenshot())
        browser.evaluate("(() => { const e = document.getElementById('cut'); e.value = ''; e.dispatchEvent(new Event('change')); })()")
        saved(page, checks, downloads, "npz")
        saved(page, checks, downloads, "vtu")

    # A reload finds the file, its options, the radius and the cut again.
    for name in ["ball.nii.gz", "sample:phantom"]:
        if name.startswith("sample:"):
            page.example(name)
        else:
            page.choose(name)
        page.settled()
        browser.evaluate("(() => { const e = document.getElementById('cut'); e.value = '1'; e.dispatchEvent(new Event('change')); const k = document.getElementById('keep-largest'); k.checked = true; })()")
        page.forget()
        browser.evaluate("document.getElementById('options').requestSubmit()")
        page.settled()
        page.forget()
        browser.evaluate("(() => { const e = document.getElementById('radius-value'); e.value = '2.5'; document.body.dataset.state = 'ready'; e.dispatchEvent(new Event('change')); })()")
        page.settled()
        time.sleep(0.5)
        before = [page.state().get("alpha"), page.state().get("betti"), page.text("command")]
        browser.call("Page.reload")
        browser.wait("document.body?.dataset.looked !== undefined", 60)
        browser.wait(f"document.body.dataset.alpha === '{before[0]}'", 60)
        page.settled()
        time.sleep(0.5)
        after = [page.state().get("alpha"), page.state().get("betti"), page.text("command")]
        kept = browser.evaluate("[document.getElementById('keep-largest').checked, document.getElementById('cut').value]")
        checks.say(f"a reload finds {name} as it was", before == after and kept == [True, "1"], f"{before}; {after}; {kept}")
    # What was changed is undone, options too.
    browser.evaluate("dispatchEvent(new KeyboardEvent('keydown', { key: 'z', ctrlKey: true }))")
    browser.evaluate("(() => { document.getElementById('keep-largest').checked = false; document.getElementById('options').requestSubmit(); })()")
    page.forget()
    page.settled()
    time.sleep(0.5)
    whole = page.state().get("betti")
    page.forget()
    browser.evaluate("document.getElementById('undo').click()")
    page.settled()
    time.sleep(0.5)
    checks.say("undo brings options back", browser.evaluate("document.getElementById('keep-largest').checked") and page.state().get("alpha") == "6.25" and page.state().get("betti") != whole, f"{page.state().get('alpha')}, {page.state().get('betti')}; {whole}")
    browser.evaluate("(() => { const e = document.getElementById('cut'); e.value = ''; e.dispatchEvent(new Event('change')); document.getElementById('keep-largest').checked = false; })()")

    # Points, balls and hidden points are drawn on request, and a click on the surface names a point.
    page.choose("duplicates.csv")
    page.settled()
    for name in ["points", "balls", "hidden"]:
        without = browser.evaluate(SCENE)
        browser.evaluate(f"document.getElementById('show-{name}').click()")
        time.sleep(1)
        checks.say(f"{name} are drawn", browser.evaluate(SCENE) != without)
        if name == "balls":
            (out / "web-balls.png").write_bytes(browser.screenshot())
        browser.evaluate(f"document.getElementById('show-{name}').click()")
        time.sleep(0.5)
    spot = browser.evaluate("(() => { const e = document.getElementById('scene'); e.scrollIntoView(); const b = e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2] })()")
    click(browser, *spot)
    checks.say("a click on the surface names a point", browser.wait("document.getElementById('picked').textContent.startsWith('point ')", 5), page.text("picked"))
    seen = browser.evaluate(SCENE)
    browser.evaluate("document.getElementById('scene').dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowLeft' }))")
    time.sleep(0.5)
    checks.say("arrow keys turn the shape", browser.evaluate(SCENE) != seen)

    # Files and folders are dropped, too.
    for name in ["ball.nrrd", "series"]:
        page.forget()
        spot = browser.evaluate("(() => { document.getElementById('drop').scrollIntoView(); const b = document.getElementById('drop').getBoundingClientRect(); return [b.x + 20, b.y + 20] })()")
        for kind in ["dragEnter", "dragOver", "drop"]:
            browser.call("Input.dispatchDragEvent", type=kind, x=spot[0], y=spot[1], data={"items": [], "files": [str(page.folder / name)], "dragOperationsMask": 1})
        agrees(page, checks, f"{name}, dropped")
    page.choose("ball.nii.gz")
    page.settled()
    page.drawer("numbers")
    lit = browser.evaluate(SCENE)
    browser.evaluate("document.querySelector('#voids button').focus()")
    time.sleep(0.7)
    checks.say("a void lights up", browser.evaluate(SCENE) != lit)

    # What cannot be read is refused as the command refuses it.
    (page.folder / "bad.nii").write_bytes(b"no volume")
    page.choose("bad.nii")
    browser.wait("document.body.dataset.state === 'failed'", 30)
    words = subprocess.run([page.walpha, "info", "bad.nii"], cwd=page.folder, capture_output=True, text=True).stderr
    why = next(line.split("why: ", 1)[1] for line in words.splitlines() if "why: " in line)
    checks.say("what cannot be read is refused in the command's words", why[:40] in page.text("failure"), page.text("failure"))
    shown = "[...document.querySelectorAll('#options label')].filter((e) => e.offsetParent).map((e) => e.querySelector('input, select').id)"
    left = browser.evaluate(shown) + [page.text("facts")]
    checks.say("and has no options, facts or slices of a file before", left == [""] and browser.evaluate("document.getElementById('slices').hidden"), str(left))
    accessible(browser, checks, "failed")
    # Where an option helps it is offered.
    (page.folder / "unnamed.csv").write_text("a,b,c\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n1,1,1\n")
    page.choose("unnamed.csv")
    browser.wait("document.body.dataset.state === 'failed'", 30)
    left = browser.evaluate(shown)
    checks.say("but the option that makes it readable", left in ([], ["columns"]), f"{left}: {page.text('failure')}")

    # Far from the origin what is saved in single precision is shifted, which the page says; what is read out is not.
    roof = [(434123.4 + 0.05 * x, 5412345.6 + 0.05 * y, 412 + 0.2 * abs(0.05 * x - 0.5) - low) for low in (0, 0.04) for y in range(20) for x in range(20)]
    (page.folder / "roof.xyz").write_text("".join(f"{x:.2f} {y:.2f} {z:.3f}\n" for x, y, z in roof))
    page.choose("roof.xyz")
    if agrees(page, checks, "roof.xyz"):
        for extension in ["stl", "glb"]:
            saved(page, checks, downloads, extension)
        told = page.text("remarks")
        checks.say("an offset is told", "434000, 5412000, 0 is subtracted" in told, told)
        spot = browser.evaluate("(() => { const e = document.getElementById('scene'); e.scrollIntoView(); const b = e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2] })()")
        click(browser, *spot)
        browser.wait("document.getElementById('picked').textContent.startsWith('point ')", 5)
        words = page.text("picked")
        numbers = [float(word) for word in words.partition("(")[2].partition(")")[0].split(",")]
        near = any(all(abs(a - b) < 1e-3 for a, b in zip(numbers, place)) for place in roof)
        checks.say("what is read out are the coordinates of the file", near, words)
    # A file that would hold nothing of the shape is refused, with an alpha at which it would not.
    page.forget()
    browser.evaluate("(() => { const e = document.getElementById('alpha-value'); e.value = 1e-9; document.body.dataset.state = 'ready'; e.dispatchEvent(new Event('change')); })()")
    page.settled()
    browser.evaluate("document.getElementById('save-stl').click()")
    browser.wait("document.body.dataset.state === 'failed'", 30)
    checks.say("an empty file is an error", "has no regular facet" in page.text("failure") and "move α up" in page.text("failure"), page.text("failure"))

    huge_file(page.folder / "huge.nii.gz")
    page.choose("huge.nii.gz")
    browser.wait("document.body.dataset.state === 'failed'", 60)
    said = page.text("failure")
    checks.say("what does not fit into memory is an error that says so", "of memory, more than is available" in said and "Next: crop" in said, said)
    page.choose("ball.xyz")
    agrees(page, checks, "after too large a file")

    (page.folder / "gone.xyz").write_text("0 0 0\n1 0 0\n0 1 0\n0 0 1\n")
    browser.choose("files", [page.folder / "gone.xyz"])
    page.settled()
    # A file that has gone since it was chosen is an error, too.
    node = browser.call("Runtime.evaluate", expression="document.getElementById('files')")["result"]["objectId"]
    browser.evaluate("document.getElementById('files').addEventListener('change', (event) => event.stopImmediatePropagation(), { capture: true, once: true })")
    browser.call("DOM.setFileInputFiles", files=[str(page.folder / "gone.xyz")], objectId=node)
    (page.folder / "gone.xyz").unlink()
    browser.evaluate("(() => { document.body.dataset.state = 'busy'; document.getElementById('files').dispatchEvent(new Event('change')); })()")
    checks.say("a file that has gone is an error", browser.wait("document.body.dataset.state === 'failed'", 10), page.text("failure"))

    # Cancelling ends the work, and the page goes on.
    page.example("sample:phantom@128")
    browser.wait("document.getElementById('status').textContent.startsWith('Computing all')", 60)
    browser.evaluate("document.getElementById('cancel').click()")
    checks.say("work can be cancelled", browser.wait("document.body.dataset.state === 'cancelled'", 20))
    started = time.monotonic()
    page.example("sample:phantom")
    checks.say("and the page goes on", page.settled() and page.state()["state"] == "ready", f"the phantom takes {time.monotonic() - started:.1f} s")
    agrees(page, checks, "phantom")

    # A cut has a face, of the cells that it cuts.
    browser.evaluate("(() => { const e = document.getElementById('cut'); e.value = '1'; e.dispatchEvent(new Event('change')); document.getElementById('colour').value = 'value'; document.getElementById('colour').dispatchEvent(new Event('change')); })()")
    time.sleep(1.5)
    (out / "web-cut.png").write_bytes(browser.screenshot())
    for name, (width, height, mobile) in SCREENS.items():
        browser.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=mobile)
        scheme = "dark" if name == "phone" else "light"
        browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        time.sleep(1)
        browser.evaluate("document.querySelectorAll('[data-drawer]').forEach((button) => button.ariaExpanded === 'true' || button.click())")
        accessible(browser, checks, f"loaded, drawers open, {name}, {scheme}")
        wide = browser.evaluate("document.documentElement.scrollWidth") - width
        checks.say(f"nothing is wider than the {name}", wide <= 0, f"{wide} pixels")
        (out / f"web-{name}.png").write_bytes(browser.screenshot())
    for example, first, all_of_them in [("sample:phantom", 10, 20), ("sample:phantom@256", 60, 120)][:2 if large else 1]:
        started = time.monotonic()
        page.example(example)
        browser.wait("document.body.dataset.looked", 200)
        browser.evaluate("new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)))")
        took = time.monotonic() - started
        checks.say(f"{example}, from the click to the picture, in {first} s", took < first, f"{took:.2f} s; a frame {page.state()['frame']} ms")
        browser.wait("document.body.dataset.alpha", 200)
        took = time.monotonic() - started
        checks.say(f"{example}, all α, in {all_of_them} s", took < all_of_them, f"{took:.2f} s; {page.text('status')}")
        page.settled(200)
    if large:
        large_file(page.folder / "large.nrrd")
        page.choose("large.nrrd")
        agrees(page, checks, "large.nrrd")
        told = page.text("remarks")
        checks.say("a volume that is too large is made coarser, and said to be", "420×420×420 samples are too many" in told, told)
    unnamed = browser.evaluate("[...document.querySelectorAll('input:not([hidden]), select, button, canvas')].filter((e) => !(e.labels?.length || e.getAttribute('aria-label') || e.tagName === 'BUTTON' && e.textContent.trim()) && e.closest('#scene') === null).map((e) => e.id)")
    checks.say("every control has a name", not unnamed, str(unnamed))
    browser.call("Emulation.setDeviceMetricsOverride", width=1400, height=950, deviceScaleFactor=1, mobile=False)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("page")
    parser.add_argument("walpha")
    parser.add_argument("--out", default=".", type=pathlib.Path)
    parser.add_argument("--large", action="store_true", help="a phantom of 256³ samples, too")
    arguments = parser.parse_args()
    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    if not chromium:
        print("there is no Chromium")
        return 77
    url = pathlib.Path(arguments.page).resolve().as_uri()
    walpha = str(pathlib.Path(arguments.walpha).resolve())
    size = pathlib.Path(arguments.page).stat().st_size
    checks = Checks()
    checks.say("the page takes at most 6 MB", size <= 6e6, f"{size / 1e6:.2f} MB")
    with tempfile.TemporaryDirectory() as place:
        folder, downloads = pathlib.Path(place, "files"), pathlib.Path(place, "downloads")
        folder.mkdir()
        downloads.mkdir()
        files = make_files(folder)
        with tempfile.TemporaryDirectory() as profile:
            browser = Chromium(chromium, profile)
            try:
                browser.attach()
                browser.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(downloads))
                browser.call("Emulation.setDeviceMetricsOverride", width=1400, height=950, deviceScaleFactor=1, mobile=False)
                browser.open(url)
                checks.say("the page is ready", browser.wait("document.body?.dataset.state === 'ready'", 60))
                browser.hear_workers()
                look_at_all(browser, Page(browser, folder, walpha), checks, files, downloads, arguments.out, arguments.large)
                wrong = faults(browser.events)
                checks.say("no error on the console, no request to a network", not wrong, "; ".join(wrong))
            finally:
                browser.close()
        firefox = shutil.which("firefox-esr") or shutil.which("firefox")
        if not firefox:
            print("skipped: there is no Firefox")
        else:
            with tempfile.TemporaryDirectory() as profile:
                browser = Firefox(firefox, profile)
                try:
                    browser.open(url)
                    checks.say("Firefox: the page is ready", browser.wait("document.body.dataset.state === 'ready'", 60), browser.evaluate("document.getElementById('failure').textContent"))
                    page = Page(browser, folder, walpha)
                    for name in ["ball.nii.gz", "two.mhd", "ball.las"]:
                        page.choose(name)
                        agrees(page, checks, f"Firefox: {name}")
                    (arguments.out / "web-firefox.png").write_bytes(browser.screenshot())
                finally:
                    browser.close()
    return 1 if checks.failed else 0


if __name__ == "__main__":
    sys.exit(main())
