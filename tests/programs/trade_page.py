# SPDX-License-Identifier: Apache-2.0
"""Uses the pages of `woodcock trade` as somebody does: trade_page.py REPORTS DIRECTORY.

The pages trade.html, scaling.html and needs.html, made from the reports, are in the directory, and
answers.json with what the models say; screenshots go there, too. Exit code 77: there is no browser here.
"""

import json
import sys

sys.dont_write_bytecode = True  # nothing is left in the source tree
from browser import Browser, find_browser  # noqa: E402


class Page(Browser):
    def __init__(self, directory, name, width=1200, height=1000, **more):
        self.page = f"file://{directory}/{name}.html"
        super().__init__(self.page, width, height, **more)
        self.wait_for("document.documentElement?.dataset.ready")
        self.settle()

    def narrow(self):
        """Becomes a phone."""
        self.call("Emulation.setDeviceMetricsOverride", width=390, height=800, deviceScaleFactor=1,
                  mobile=True)
        self.wait_for("document.querySelector('svg[viewBox]').getBoundingClientRect().width < 390")
        self.settle()

    def text(self, selector):
        return self.evaluate(f"document.querySelector({selector!r}).textContent")

    def texts(self, selector):
        return self.evaluate(f"[...document.querySelectorAll({selector!r})].map(e => e.textContent)")

    def count(self, selector):
        return self.evaluate(f"document.querySelectorAll({selector!r}).length")

    def click(self, selector, which=0):
        self.evaluate(f"document.querySelectorAll({selector!r})[{which}].click()")
        self.settle()

    def enter(self, selector, value):
        self.evaluate(f"(() => {{ const e = document.querySelector({selector!r}); e.value = {value}; "
                      "e.dispatchEvent(new Event('input', {bubbles: true})); })()")
        self.settle()

    def check_clean(self):
        assert not self.errors, self.errors
        outside = [r for r in self.requests if r != self.page and not r.startswith("data:")]
        assert not outside, outside
        assert self.evaluate("window.pwned === undefined"), "a name became a script"
        drawn = self.texts("svg text")
        assert drawn and not any("NaN" in t or "undefined" in t for t in drawn), drawn
        assert not self.evaluate("/NaN|undefined|null/.test(main.innerText)")
        assert self.evaluate("document.documentElement.scrollWidth <= innerWidth"), "sticks out"

    def check_labels_apart(self, chart):
        """No two texts of a drawing lie on one another."""
        assert self.evaluate(
            f"""(() => {{
            const boxes = [...document.querySelectorAll({chart + " svg text"!r})]
                .map(t => t.getBoundingClientRect());
            return !boxes.some((a, i) => boxes.some((b, j) => j > i && a.left < b.right - 1 &&
                b.left < a.right - 1 && a.top < b.bottom - 4 && b.top < a.bottom - 4)); }})()"""), chart


def usable(report):
    return [(i, c) for i, c in enumerate(report["candidates"]) if c["variance"]]


class Answers:
    """What the program's own models say to a question, from answers.json."""

    def __init__(self, directory):
        with open(f"{directory}/answers.json") as file:
            self.all = json.load(file)

    def to(self, kind, target, unbiased=False, loading=False):
        return next(a for a in self.all if a["kind"] == kind and a["target"] == target
                    and a["unbiased"] == unbiased and a["loading"] == loading)

    def targets(self, kind):
        return sorted({a["target"] for a in self.all if a["kind"] == kind})


def check_answer(p, report, expected):
    """The page shows this answer."""
    candidates = report["candidates"]
    named = lambda k: f"{k + 1} {candidates[k]['name']}"
    if expected["best"] is None:
        assert "none" in p.text(".answer"), (expected, p.text(".answer"))
        assert not p.count("#answer code")
        return
    taken = expected["recommended"]
    assert named(taken) in p.text(".answer"), (expected, p.text(".answer"))
    assert p.text("#answer code").startswith(candidates[taken]["command"])
    assert f"{expected['samples']:.0f} sample" in p.text("#answer"), p.text("#answer")
    rows = p.evaluate("[...document.querySelectorAll('.ranking tbody tr:not(.share)')].map(r =>"
                      "[r.cells[0].textContent, r.cells[2]?.textContent])")
    able = rows[:len(expected["order"])]
    assert [name for name, _ in able] == [named(k) for k in expected["order"]], (expected, rows)
    assert able[0] == [named(expected["best"]), "best"], rows
    tied = {name for name, mood in rows if mood == "tied"}
    assert tied == {named(k) for k in expected["tied"]}, (expected, rows)
    assert all(mood is None for _, mood in rows[len(able):]), "the others cannot"
    others = {expected["best"], *expected["tied"]} - {taken}
    alike = p.evaluate("[...document.querySelectorAll('#answer p')].map(e => e.textContent)"
                       ".find(t => t.startsWith('Cannot be told from it'))")
    assert bool(alike) == bool(others), (expected, alike)
    assert all(named(k) in alike for k in others), (expected, alike)


def check_answers(p, report, answers):
    """To each question, whatever counts."""
    some_tied = 0
    for loading in (False, True):
        for unbiased in (False, True):
            for kind in ("time", "error"):
                p.click(f"[data-kind={kind}]")
                for target in answers.targets(kind):
                    expected = answers.to(kind, target, unbiased, loading)
                    p.enter("#target", target)
                    check_answer(p, report, expected)
                    some_tied += len(expected.get("tied", []))
            p.click("#unbiasedOnly")
        p.click("#loading")
    assert some_tied, "the example has no ties"
    p.click("[data-kind=time]")


def check_recommendation(p, report, answers):
    name = lambda i: report["candidates"][i]["name"]
    best_in = lambda seconds, **asked: answers.to("time", seconds, **asked)["recommended"]
    found = set()
    for seconds in (0.05, 1, 10, 100):
        p.enter("#target", seconds)
        found.add(best_in(seconds))
        assert f"--time-limit {seconds}s" in p.text("#answer code"), p.text("#answer code")
    assert len(found) >= 3, "the example has one best choice only"
    assert p.evaluate("Number(document.getElementById('slider').value)") > 900
    p.enter("#slider", 0)
    assert "octaves" not in p.text(".answer"), "it is too slow for the shortest time"
    # Small steps of the slider add up, though the answers' times are further apart.
    p.enter("#target", 1)
    at = p.evaluate("Number(document.getElementById('slider').value)")
    p.evaluate("document.getElementById('slider').focus()")
    for _ in range(12):
        p.evaluate("(() => { const s = document.getElementById('slider'); s.stepUp(); "
                   "s.dispatchEvent(new Event('input', {bubbles: true})); })()")
    assert p.evaluate("Number(document.getElementById('slider').value)") == at + 12
    assert "For 1.1" in p.text(".answer"), p.text(".answer")
    p.evaluate("document.activeElement.blur()")
    p.enter("#target", 7.37)
    assert "For 7.4" in p.text(".answer"), "the nearest time that was answered"
    assert "--time-limit 7.4s" in p.text("#answer code"), p.text("#answer code")
    assert p.evaluate("document.getElementById('target').value") == "7.4"
    p.enter("#target", 10)
    own = next(r for r in report["recommendations"] if r["kind"] == "time" and r["target"] == 10)
    assert p.text("#answer code") == own["command"]
    assert best_in(10, unbiased=True) != best_in(10), "all of the example's best are unbiased"
    assert f"Best without bias: {best_in(10, unbiased=True) + 1} " in p.text("#answer")
    assert best_in(0.3, loading=True) != best_in(0.3), "the example's loading changes nothing"
    p.click("[data-kind=error]")
    p.enter("#target", 0.003)
    assert "--spp " in p.text("#answer code")
    p.enter("#target", 1e-9)
    assert "as the scene says" in p.text(".answer"), "where a bias decides that may not be there"
    assert "8-bit fields" in p.text("#answer"), "it may be as good"
    p.click("[data-recommendation]")
    assert p.text("[data-kind][aria-pressed=true]") == "A time"
    p.evaluate("navigator.clipboard.writeText = async text => { window.copied = text; }")
    p.click("#answer .copy")
    assert p.evaluate("window.copied") == p.text("#answer code")


def check_error_plot(p, report):
    count = sum(len(c["points"]) for c in report["candidates"])
    assert p.count(".chart .point") == count, p.count(".chart .point")
    with_lines = len(usable(report))
    assert p.count(".chart .drawing .curve") == with_lines
    assert p.count(".chart .drawing .curve.dashed") == sum(c["biased"] for c in report["candidates"])
    assert p.count(".chart .front") == 1
    assert "the reference's own error" in p.texts(".chart svg text")
    # Twice the time moves the mark to the right; the plot is that of the time asked for.
    places = []
    for seconds in (1, 2, 4):
        p.enter("#target", seconds)
        places.append(float(p.evaluate("document.querySelector('.chosen').getAttribute('x1')")))
    assert abs(places[2] - 2 * places[1] + places[0]) < 0.01 and places[1] > places[0], places
    p.click(".keys [data-series='3']")
    assert p.count(".chart .point") == count - len(report["candidates"][3]["points"])
    assert p.evaluate("document.querySelector(\".keys [data-series='3']\").ariaPressed") == "false"
    p.click(".keys [data-series='3']")
    p.evaluate("document.querySelector('.drawing').focus()")
    p.key("ArrowRight"), p.key("ArrowRight")
    assert "16 samples" in p.text(".tip") and "as the scene says" in p.text(".tip"), p.text(".tip")
    assert "16 samples" in p.text(".chart [role=status]")
    p.key("ArrowDown")
    assert "ratio tracking" in p.text(".tip"), p.text(".tip")
    p.key("Escape")
    assert p.evaluate("document.querySelector('.tip').hidden")
    p.evaluate("document.querySelector('.drawing').scrollIntoView({block: 'center'})")
    box = p.evaluate("(() => { const b = document.querySelectorAll('.chart .point .mark')[0]"
                     ".getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })()")
    p.mouse("mouseMoved", *box)
    assert "4 samples" in p.text(".tip"), p.text(".tip")
    p.mouse("mouseMoved", 5, 5)
    p.check_labels_apart(".chart")


def check_tables(p, report):
    names = "td.first .who"
    heading = p.evaluate("candidateColumns.findIndex(c => c.name === 'Time per sample')")
    p.click(f"[data-column='{heading}']")
    times = [c["seconds_per_sample"]["value"] for _, c in usable(report)]
    order = lambda: p.evaluate("[...document.querySelectorAll('th[aria-sort]')][0].closest('table')"
                               ".querySelectorAll('tbody tr').length")
    assert order() == len(report["candidates"])
    first = sorted(usable(report), key=lambda x: x[1]["seconds_per_sample"]["value"])
    shown = p.texts(names)[:len(report["candidates"])]
    assert [t.split(" ", 1)[1] for t in shown[:len(times)]] == [c["name"] for _, c in first], shown
    assert "too slow" in shown[-1], "what was not measured comes last"
    p.click(f"[data-column='{heading}']")
    shown = p.texts(names)[:len(report["candidates"])]
    assert shown[0].split(" ", 1)[1] == first[-1][1]["name"], shown
    assert "too slow" in shown[-1]
    assert p.count("th[aria-sort=descending]") == 1
    readings = report["equal_time"] + report["equal_error"]
    assert p.count("td.best") == len(readings)
    assert p.count("td.tied") == sum(len(e["tied"]) for e in readings)
    never = sum(r["seconds"] is None for e in report["equal_error"] for r in e["rows"])
    assert p.texts("td .soft").count("never") == never > 0
    assert any("not seen" in t for t in p.texts("td")), "an unresolved bias says so"
    assert report["notes"][0] in p.text(".notes")
    assert report["scene"] in p.text("h1")


def check_crops(p, report):
    assert p.count(".crops figure") == len(report["crops"])
    p.click("[data-crop]", 1)
    assert p.evaluate("document.querySelector('dialog').open")
    assert p.text("dialog figcaption") == report["crops"][1]["title"]
    p.call("Input.dispatchKeyEvent", type="keyDown", key=" ", text=" ")
    p.settle()
    assert p.text("dialog figcaption") == "reference"
    p.call("Input.dispatchKeyEvent", type="keyUp", key=" ")
    p.settle()
    assert p.text("dialog figcaption") == report["crops"][1]["title"]
    p.key("ArrowRight")
    assert p.text("dialog figcaption") == report["crops"][2]["title"]
    x, y = p.evaluate("(() => { const b = document.querySelector('dialog img').getBoundingClientRect();"
                      "return [b.x + b.width / 2, b.y + b.height / 2]; })()")
    p.mouse("mousePressed", x, y, button="left", clickCount=1)
    assert p.text("dialog figcaption") == "reference"
    p.mouse("mouseReleased", x, y, button="left", clickCount=1)
    assert p.text("dialog figcaption") == report["crops"][2]["title"]
    p.key("Escape")
    p.evaluate("document.querySelector('dialog').close()")


def check_trade(directory, report):
    answers = Answers(directory)
    for dark in (False, True):
        p = Page(directory, "trade", dark=dark)
        try:
            p.screenshot(f"{directory}/trade_{'dark' if dark else 'light'}.png")
            check_recommendation(p, report, answers)
            check_answers(p, report, answers)
            check_error_plot(p, report)
            check_tables(p, report)
            check_crops(p, report)
            background = p.evaluate("getComputedStyle(document.body).backgroundColor")
            assert background == ("rgb(21, 24, 27)" if dark else "rgb(251, 250, 247)"), background
            p.check_clean()
            if dark:
                p.narrow()
                p.check_labels_apart(".chart")
                p.screenshot(f"{directory}/trade_phone.png")
                p.check_clean()
        finally:
            p.close()


def check_scaling(directory, report):
    p = Page(directory, "scaling")
    try:
        points = sum(len(s["points"]) for c in report["curves"] for s in c["series"])
        assert p.count(".chart") == len(report["curves"])
        assert p.count(".chart .point") == points
        assert any("power 0.31 ± 0.02" in t for t in p.texts(".keys button"))
        # The drawn line has the slope that was fitted.
        slope = p.evaluate("""(() => { const s = report.curves[0].series[0];
            const [a, b] = fittedLine(report.curves[0], s.points, s.slope);
            return Math.log(b[1] / a[1]) / Math.log(b[0] / a[0]); })()""")
        assert abs(slope - report["curves"][0]["series"][0]["slope"]["value"]) < 1e-9, slope
        assert p.texts("section:last-child td")[-2:] == ["–", "–"], "what is null is a dash"
        for narrow in (False, True):
            if narrow:
                p.narrow()
            for i in range(len(report["curves"])):
                p.check_labels_apart(f".curves > :nth-child({i + 1})")
            p.screenshot(f"{directory}/scaling_{'phone' if narrow else 'light'}.png")
            p.check_clean()
    finally:
        p.close()


def check_needs(directory, report):
    p = Page(directory, "needs", dark=True)
    try:
        bars = sum(row["ratio"] is not None for row in report["rows"])
        assert p.count("svg .body") == bars
        assert p.text("h1").startswith("1 specialisation of 3 "), p.text("h1")
        assert "10 %" in p.texts("svg text")
        p.click("[data-column='4']")
        ratios = p.texts("tbody td:nth-child(5)")
        assert ratios == ["1.04 ± 0.011", "1.159 ± 0.011", "1.458 ± 0.012", "–"], ratios
        p.screenshot(f"{directory}/needs_dark.png")
        p.check_clean()
        p.narrow()
        p.screenshot(f"{directory}/needs_phone.png")
        p.check_clean()
    finally:
        p.close()


def main(reports, directory):
    if not find_browser():
        print("no chromium here")
        return 77
    with open(reports) as file:
        all_reports = json.load(file)
    check_trade(directory, all_reports["trade"])
    check_scaling(directory, all_reports["scaling"])
    check_needs(directory, all_reports["needs"])
    print("all checks pass")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
