# SPDX-License-Identifier: Apache-2.0
"""Uses the page of `woodcock compare --report` as somebody does: compare_page.py PAGE DIRECTORY.

The images are those of tests/tools/compare_page_test.cpp. Screenshots go to the directory. Exit code
77: there is no browser here.
"""

import sys
import time

sys.dont_write_bytecode = True  # nothing is left in the source tree
from browser import Browser, find_browser  # noqa: E402

WIDTH, HEIGHT = 64, 48
BROKEN = (5, 5)  # B's NaN


def a(x, y):
    return [0.05 + 0.01 * x, 0.01 * (y + 1), 0.3]


def b(x, y):
    return [v + (0.04 if x < 32 else -0.04) for v in a(x, y)]


def srgb(light):
    encode = lambda v: 12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055
    return [255 * min(1, max(0, encode(max(0, v)))) for v in light]


class Page(Browser):
    def __init__(self, page, width, height, **more):
        super().__init__(f"file://{page}", width, height, **more)
        self.page = page
        self.wait_for("document.documentElement?.dataset.ready")
        self.settle()
        assert self.evaluate("document.documentElement.dataset.ready") == "true"
        self.evaluate("canvas.scrollIntoView({block: 'end'})")

    def colour(self, x, y, pane=0):
        """What the canvas shows of an image's pixel."""
        self.settle()
        return self.evaluate(
            f"[...context.getImageData(...toScreen(panes()[{pane}], {x} + 0.5, {y} + 0.5), 1, 1)"
            ".data].slice(0, 3)")

    def place(self, x, y):
        """Where on the screen that pixel is."""
        return self.evaluate(
            f"""(() => {{ const box = canvas.getBoundingClientRect();
            const [px, py] = toScreen(panes()[0], {x} + 0.5, {y} + 0.5);
            return [box.left + px * box.width / canvas.width,
                    box.top + py * box.height / canvas.height]; }})()""")

    def text(self, selector):
        return self.evaluate(f"document.querySelector({selector!r}).textContent")

    def click(self, selector):
        self.evaluate(f"document.querySelector({selector!r}).click()")
        self.settle()

    def check_clean(self):
        assert not self.errors, self.errors
        assert self.requests == [f"file://{self.page}"], self.requests


def near(found, expected, within):
    assert max(abs(f - e) for f, e in zip(found, expected)) <= within, (found, expected)


def check_slider(p):
    near(p.colour(10, 20), srgb(a(10, 20)), 2)
    near(p.colour(50, 20), srgb(b(50, 20)), 2)
    x0, y0 = p.place(31.5, 40)
    x1, _ = p.place(56, 40)
    p.drag(x0, y0, x1, y0)  # the divider
    assert p.evaluate("state.x") == WIDTH / 2, "the image stays"
    near(p.colour(50, 20), srgb(a(50, 20)), 2)
    for _ in range(30):
        p.key(",")
    near(p.colour(20, 20), srgb(b(20, 20)), 2)
    p.evaluate("state.split = 0.5, update()")


def check_flicker(p):
    p.key("f")
    near(p.colour(50, 20), srgb(a(50, 20)), 2)
    p.key(" ")
    near(p.colour(50, 20), srgb(b(50, 20)), 2)
    p.key(" ")
    near(p.colour(10, 20), srgb(a(10, 20)), 2)
    p.key("a")
    seen = set()
    end = time.monotonic() + 10
    while len(seen) < 2 and time.monotonic() < end:
        seen.add(tuple(p.colour(50, 20)))
    assert len(seen) == 2, "it flickers by itself"
    p.key("a")


def check_side_by_side(p):
    p.key("b")
    near(p.colour(30, 20, 0), srgb(a(30, 20)), 2)
    near(p.colour(30, 20, 1), srgb(b(30, 20)), 2)
    before = p.evaluate("scale()")
    p.key("+")
    assert p.evaluate("scale()") > before
    near(p.colour(36, 20, 0), srgb(a(36, 20)), 2)
    near(p.colour(36, 20, 1), srgb(b(36, 20)), 2)
    p.key("0")
    assert abs(p.evaluate("scale()") - before) < 1e-9


def check_exposure_and_views(p):
    p.key("s")
    p.key("e")
    near(p.colour(10, 20), srgb([v * 2 ** 0.5 for v in a(10, 20)]), 2)
    p.key("e")
    near(p.colour(10, 20), srgb([v * 2 for v in a(10, 20)]), 2)
    p.key("E"), p.key("E")
    names = p.evaluate("views.map(v => v.name)")
    assert names == ["sRGB", "Raw numbers", "OCIO: ACES", "OCIO: Standard"], names
    p.key("v")
    near(p.colour(10, 20), [255 * v for v in a(10, 20)], 2)
    p.key("v")
    aces = p.colour(10, 20)
    p.key("v")
    near(p.colour(10, 20), srgb(a(10, 20)), 3)  # that view is sRGB's curve
    assert max(abs(f - e) for f, e in zip(aces, p.colour(10, 20))) > 10, "ACES is another look"
    p.key("v")


def check_difference(p):
    p.key("d")
    assert p.text("#tag-left") == "B − A"
    assert p.text("#scale span") == "−0.05", p.text("#scale span")
    red, blue, odd = p.colour(10, 20), p.colour(50, 20), p.colour(*BROKEN)
    assert red[0] > red[2] + 50 and blue[2] > blue[0] + 50, (red, blue)
    assert odd == [255, 0, 255], odd
    p.key("]")
    assert p.text("#scale span") == "−0.1"
    pale = p.colour(10, 20)
    assert pale[2] > red[2], "a larger range makes it paler"
    p.key("r")
    assert p.text("#scale span").endswith("%")
    p.evaluate("document.getElementById('right').value = 0")
    p.evaluate("document.getElementById('right').dispatchEvent(new Event('input', {bubbles: true}))")
    near(p.colour(10, 20), [244, 244, 240], 1)  # A is equal to A
    p.key("n")
    p.key("p")
    assert p.text("#tag-left").startswith("HDR-FLIP of B")
    assert p.colour(10, 20) != [0, 0, 4]
    p.key("d"), p.key("t")
    assert p.evaluate("packed.tiles[0].length") == 48, "every tile of B differs"
    p.key("t"), p.key("s")


def check_pixels(p):
    p.mouse("mouseMoved", *p.place(12, 30))
    rows = p.evaluate("[...document.querySelectorAll('#readout tr')].map(r => "
                      "[...r.cells].map(c => c.textContent))")
    assert rows[0][0] == "12, 30", rows
    for row, va, vb in zip(rows[1:], a(12, 30), b(12, 30)):
        near([float(row[1]), float(row[2])], [va, vb], 2e-5)
        near([float(row[3].replace("−", "-"))], [0.04], 1e-4)
    p.evaluate("canvas.focus()")
    p.key("ArrowRight", shift=True)
    assert p.text("#readout th") == "13, 30"
    x, y = map(round, p.place(40, 10))  # the browser rounds the pointer's place
    under = f"toImage(...at({{clientX: {x}, clientY: {y}}}))"
    before = p.evaluate(under)
    p.mouse("mouseWheel", x, y, deltaX=0, deltaY=-1500)
    assert p.evaluate("scale()") > 50
    near(p.evaluate(under), before, 1e-6)  # what is under the pointer stays there
    state = p.evaluate("[state.x, state.y]")
    p.key("ArrowLeft")
    assert p.evaluate("state.x") < state[0]
    p.drag(x, y, x + 60, y)
    assert p.evaluate("state.x") < state[0] - 0.5
    p.key("0")
    p.click("[data-x]")  # a place of the tables
    assert p.evaluate("scale()") == 24
    assert p.evaluate("state.pixel !== null")
    p.key("0")


def check_tables(p):
    assert p.text("h1") == "B, C differ from A", p.text("h1")
    assert "NaN" in p.text("main")
    headings = p.evaluate("[...document.querySelectorAll('.card h3')].map(h => h.textContent)")
    assert "RMSE against samples" in headings and "RMSE against seconds" in headings, headings
    assert "R: values" in headings and "B: C − A" in headings, headings
    assert p.evaluate("document.querySelectorAll('.card svg polyline').length") >= 12
    marks = p.evaluate("[...document.querySelectorAll('svg text')].some(t => t.textContent === 'NaN')")
    assert not marks, "no plot has a NaN"


def check_phone(page, directory):
    p = Page(page, 390, 800, dark=True, touch=True)
    try:
        assert p.evaluate("document.documentElement.scrollWidth") <= 390, "nothing sticks out"
        background = p.evaluate("getComputedStyle(document.body).backgroundColor")
        assert background == "rgb(21, 24, 27)", background
        x, y = p.place(10, 20)
        p.touch("touchStart", (x, y))
        p.touch("touchEnd")
        assert p.text("#readout th") == "10, 20", p.text("#readout th")
        before = p.evaluate("scale()")
        x, y = p.place(20, 24)
        p.touch("touchStart", (x - 20, y), (x + 20, y))
        for spread in (30, 40, 60):
            p.touch("touchMove", (x - spread, y), (x + spread, y))
        p.touch("touchEnd")
        assert p.evaluate("scale()") > 2 * before, "two fingers zoom"
        p.click("[data-mode=side]")
        p.screenshot(f"{directory}/phone.png")
        p.check_clean()
    finally:
        p.close()


def main(page, directory):
    if not find_browser():
        print("no chromium here")
        return 77
    p = Page(page, 1200, 1000)
    try:
        check_slider(p)
        p.screenshot(f"{directory}/light.png")
        check_flicker(p)
        check_side_by_side(p)
        check_exposure_and_views(p)
        check_difference(p)
        check_pixels(p)
        check_tables(p)
        p.check_clean()
    finally:
        p.close()
    check_phone(page, directory)
    print("all checks pass")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
