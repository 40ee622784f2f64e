// SPDX-License-Identifier: Apache-2.0
// What each specialisation saves: the time without it over the time with it.

const report = dataOf("report"),
    rows = (report.rows || []).map((r, index) => ({ ...r, index, key: String(index + 1) }));
const withSe = (m, unit = "") =>
    isNumber(m?.value)
        ? `${number(m.value, 4)}${m.se > 0 ? ` ± ${number(m.se, 2)}` : ""}${unit}`
        : "–";
const least = 1.1;
const signs = { earns: "✓ earns", "does not earn": "✗ does not earn", needed: "needed" };

main.innerHTML = "";
section((s) => {
    const failing = rows.filter((r) => r.verdict === "does not earn");
    const several = plural(failing.length, "specialisation");
    const verdict = failing.length
        ? `${several} of ${rows.filter((r) => !r.needed).length} ` +
          `${failing.length === 1 ? "does" : "do"} not earn 10 %`
        : "Each specialisation that this scene uses earns its 10 %";
    s.innerHTML =
        `<h1 class="${failing.length ? "bad" : "good"}">${verdict}</h1>
        <p class="soft">${escape(report.scene ?? "")}; woodcock
        ${escape(report.woodcock?.version ?? "")}. A render leaves out what the scene does not need.
        Here each such feature was rendered as if it were needed. The ratio is the time with it over
        the time without. A feature whose ratio is below ${least} is not worth its code. ± is one
        standard error.</p>` +
        ((report.notes || []).length
            ? `<ul>${report.notes.map((n) => `<li>${escape(n)}</li>`).join("")}</ul>`
            : "");
});
section((s) => {
    const measured = rows
        .filter((r) => isNumber(r.ratio?.value))
        .map((r) => ({
            ...r,
            name: r.need,
            value: r.ratio.value,
            se: r.ratio.se || 0,
            text: `× ${withSe(r.ratio)}`,
        }));
    s.hidden = !measured.length;
    if (measured.length)
        rowChart(s, "What each unneeded feature would cost", measured, {
            unit: "",
            bars: true,
            from: 1,
            lines: [
                [1, "", "zero"],
                [least, "10 %", "limit"],
            ],
            note:
                "Thick bars are one standard error, thin ones two. " +
                "Those that end right of the dashed line earn their place.",
        });
});
section((s) => {
    const columns = [
        {
            name: "Need",
            key: (r) => r.index,
            html: (r) => `<b class="key c${r.index % colourCount}">${r.key}</b> ${escape(r.need)}`,
        },
        {
            name: "Of this scene",
            key: (r) => Number(r.needed),
            text: (r) => (r.needed ? "needed" : "not needed"),
        },
        {
            name: "Time as it renders",
            key: (r) => r.seconds?.value,
            text: (r) => withSe(r.seconds, " s"),
        },
        {
            name: "With the feature",
            key: (r) => r.pretended?.value,
            text: (r) => withSe(r.pretended, " s"),
        },
        { name: "Ratio", key: (r) => r.ratio?.value, text: (r) => withSe(r.ratio) },
        {
            name: "Verdict",
            key: (r) => ["does not earn", "earns", "needed"].indexOf(r.verdict),
            text: (r) => signs[r.verdict] || r.verdict || "–",
            mood: (r) =>
                r.verdict === "earns" ? "good" : r.verdict === "does not earn" ? "bad" : "soft",
        },
    ];
    s.innerHTML = `<h2>Table</h2><p class="soft">Press a heading to sort.</p>
        <div class="wide"></div>`;
    sortableTable(s.lastElementChild, () => rows, columns, { column: columns[0], down: false });
});
keepPlots();
document.documentElement.dataset.ready = true;
