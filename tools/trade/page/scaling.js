// SPDX-License-Identifier: Apache-2.0
// How cost grows: curves with their fitted slopes, and tables.

const report = dataOf("report");
const withSe = (v, se) =>
    isNumber(v) ? number(v, 4) + (isNumber(se) && se > 0 ? ` ± ${number(se, 2)}` : "") : "–";

/**
 * The line of the fitted slope through the points' middle, as the axes show it: each point counts
 * by its relative error, if all have one.
 */
function fittedLine({ x, y }, points, slope) {
    if (!isNumber(slope?.value) || points.length < 2 || !x.log !== !y.log) return null;
    const [scale, back] = x.log ? [Math.log, Math.exp] : [(v) => v, (v) => v];
    const weights = points.map((p) =>
            points.every((q) => q.se > 0) ? Math.pow(x.log ? p.y / p.se : 1 / p.se, 2) : 1,
        ),
        sum = (f) => points.reduce((s, p, i) => s + weights[i] * f(p), 0);
    const total = sum(() => 1),
        u = sum((p) => scale(p.x)) / total,
        v = sum((p) => scale(p.y)) / total;
    return [points[0], points[points.length - 1]].map((p) => [
        p.x,
        back(v + slope.value * (scale(p.x) - u)),
    ]);
}

const slopeText = ({ x, y }, slope) =>
    !isNumber(slope?.value)
        ? ""
        : x.log && y.log
          ? `grows as the power ${withSe(slope.value, slope.se)}`
          : `slope ${withSe(slope.value, slope.se)}`;

function curvePlot(parent, curve) {
    const drawable = (p) =>
        isNumber(p.x) && isNumber(p.y) && (!curve.x.log || p.x > 0) && (!curve.y.log || p.y > 0);
    const series = curve.series.map((s, index) => {
        const points = s.points.filter(drawable).sort((a, b) => a.x - b.x),
            fit = fittedLine(curve, points, s.slope),
            slope = slopeText(curve, s.slope);
        return {
            index,
            hollow: false,
            dashed: Boolean(fit),
            key: String(index + 1),
            name: slope ? `${s.name}: ${slope}` : s.name,
            line: fit || points.map((p) => [p.x, p.y]),
            points: points.map((p) => ({
                ...p,
                text: [
                    `${curve.x.label} ${number(p.x, 4)}`,
                    `${curve.y.label} ${withSe(p.y, p.se)}`,
                ],
            })),
        };
    });
    const made = chart(parent, { title: curve.name, x: curve.x, y: curve.y, series });
    const rows = curve.series.flatMap((s) => s.points.map((p) => ({ s, p })));
    made.card.insertAdjacentHTML(
        "beforeend",
        (curve.note ? `<p class="legend">${escape(curve.note)}</p>` : "") +
            `<details><summary>As a table</summary><div class="wide">${table(rows, [
                { name: "Series", text: (r) => r.s.name },
                { name: curve.x.label, text: (r) => number(r.p.x, 5) },
                { name: curve.y.label, text: (r) => withSe(r.p.y, r.p.se) },
            ])}</div></details>`,
    );
}

const cellText = (v) =>
    v === null || v === undefined
        ? "–"
        : typeof v === "number"
          ? number(v, 5)
          : typeof v === "object"
            ? withSe(v.value, v.se)
            : String(v);

main.innerHTML = "";
section((s) => {
    s.innerHTML =
        `<h1>How cost grows</h1><p class="soft">woodcock ${escape(report.woodcock?.version ?? "")}.
            Points have bars of one standard error; dashed lines are the fitted slopes: on two
            logarithmic axes, a slope of 1 is twice the cost for twice the size. Press a name to
            hide or show it.</p>` +
        ((report.notes || []).length
            ? `<ul>${report.notes.map((n) => `<li>${escape(n)}</li>`).join("")}</ul>`
            : "") +
        `<div class="plots curves"></div>`;
    for (const curve of report.curves || []) curvePlot(s.lastElementChild, curve);
});
for (const t of report.tables || [])
    section((s) => {
        s.innerHTML = `<h2>${escape(t.title)}</h2><div class="wide">${table(
            t.rows,
            t.columns.map((name, i) => ({ name, text: (row) => cellText(row[i]) })),
        )}</div>`;
    });
document.documentElement.dataset.ready = true;
