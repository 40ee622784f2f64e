// SPDX-License-Identifier: Apache-2.0
// Error against time, and the biases.

/** What the model says of a candidate, from its first sample to the last sensible time. */
const modelLine = (c) =>
    sensible("time")
        .map((at) => [answers.time.targets[at], reached(c, "time", at).value])
        .filter(([, relmse]) => relmse !== null);

/** The lowest of the models shown, as pieces without a gap. */
const frontLine = (shown) =>
    sensible("time")
        .map((at) => [
            answers.time.targets[at],
            Math.min(...shown.map((c) => reached(c, "time", at).value ?? Infinity)),
        ])
        .filter(([, relmse]) => relmse < Infinity);

function pointsTable() {
    const rows = candidates.flatMap((c) => (c.points || []).map((p) => ({ c, p })));
    return `<details><summary>The points as a table</summary><div class="wide">${table(rows, [
        { name: "Choice", html: (r) => nameOf(r.c) },
        { name: "samples", text: (r) => number(r.p.samples) },
        { name: "seconds", text: (r) => number(r.p.seconds, 3) },
        { name: "relMSE", text: (r) => withError(r.p.relmse, r.p.relmse_se) },
        { name: "rms", text: (r) => rms(r.p.relmse) },
        { name: "FLIP", text: (r) => withError(r.p.flip, r.p.flip_se) },
    ])}</div></details>`;
}

function errorPlot(section) {
    section.innerHTML = `<h2>Error against time</h2><p class="soft">Points are measured, with bars
        of one standard error; lines are the model, variance / samples + (rms bias)². Unbiased
        choices are filled and solid, biased ones hollow and dashed: their lines end at their bias.
        The broad band is the Pareto front of those shown: nothing is better in that time.</p>`;
    const series = candidates.map((c) => ({
        ...c,
        line: modelLine(c),
        points: (c.points || [])
            .filter((p) => isNumber(p.seconds) && isNumber(p.relmse) && p.relmse > 0)
            .map((p) => ({
                x: p.seconds + loadingOf(c),
                y: p.relmse,
                se: p.relmse_se,
                text: [
                    `${plural(p.samples, "sample")}, ${seconds(p.seconds + loadingOf(c))}`,
                    `relMSE ${withError(p.relmse, p.relmse_se)} (${rms(p.relmse)} rms)`,
                    isNumber(p.flip) ? `FLIP ${withError(p.flip, p.flip_se)}` : "",
                ].filter(Boolean),
            })),
    }));
    const noise = report.reference?.relmse;
    return chart(section, {
        title: "relMSE against seconds",
        x: {
            label: settings.loading ? "seconds, with loading" : "seconds of rendering",
            log: true,
        },
        y: { label: "relMSE", log: true },
        series,
        keys: true,
        height: 440,
        // The models' ends and the reference's own error are to be seen.
        extent: {
            x: domain("time"),
            y: [...series.flatMap((s) => s.line.map((p) => p[1])), noise],
        },
        behind: (f, shown) =>
            path(
                frontLine(shown.map((s) => candidates[s.index])).map(([t, e]) => [
                    f.px(t),
                    f.py(e),
                ]),
                "front",
            ) +
            (noise > 0
                ? line(f.left, f.py(noise), f.right, f.py(noise), "limit") +
                  label(f.left + 4, f.py(noise) - 4, "the reference's own error", "start")
                : "") +
            (settings.kind === "time"
                ? line(f.px(target()), f.top, f.px(target()), f.bottom, "chosen")
                : line(f.left, f.py(target()), f.right, f.py(target()), "chosen")),
    });
}

function biasPlots(section) {
    section.innerHTML = `<h2>Bias</h2><p class="soft">Thick bars are one standard error, thin ones
        two. An unbiased choice should reach zero with its thin bar nineteen times out of
        twenty.</p><div class="plots pairs"></div>`;
    const box = section.lastElementChild,
        scaled = (m) => 100 * valueOf(m);
    rowChart(
        box,
        "Bias of the image's mean",
        candidates.map((c) => ({
            ...c,
            value: scaled(c.bias),
            se: 100 * errorOf(c.bias),
            text: withError(c.bias?.value, c.bias?.se, 100, " %"),
        })),
        {
            unit: " %",
            lines: [[0, "", "zero"]],
            note: "Too dark on the left of zero, too bright on the right.",
        },
    );
    rowChart(
        box,
        "Bias from pixel to pixel, rms",
        candidates.map((c) => ({
            ...c,
            value: scaled(c.rms_bias),
            se: 100 * errorOf(c.rms_bias),
            text: rmsBiasText(c),
        })),
        {
            unit: " %",
            lines: [[0, "", "zero"]],
            note:
                "This much of the error stays however long it renders. " +
                "Where it is not seen, it is below what this budget can see.",
        },
    );
}
const rmsBiasText = (c) =>
    c.rms_bias?.resolved === false
        ? `not seen (± ${percent(errorOf(c.rms_bias))})`
        : withError(c.rms_bias?.value, c.rms_bias?.se, 100, " %");
