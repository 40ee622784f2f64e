// SPDX-License-Identifier: Apache-2.0
// Charts of one value a row.

/**
 * Rows of name, mark and bars of one and two standard errors, names above: {index, hollow, key,
 * name, value, se, text, missing}. `lines` are [value, text, class].
 */
function rowChart(
    parent,
    title,
    rows,
    { unit = "", lines = [], bars = false, from = 0, note = "" } = {},
) {
    const known = rows.filter((r) => Number.isFinite(r.value)),
        ends = known.flatMap((r) => [r.value - 2 * (r.se || 0), r.value + 2 * (r.se || 0)]);
    const tall = 36,
        height = rows.length * tall + 44;
    const values = [...ends, ...lines.map((l) => l[0]), from],
        scale = axis({ label: "", log: false }, values);
    const text = rows.map((r) => `${r.name} ${r.text}`).join("; ");
    plot(parent, title, { height, label: `${title}: ${text}`, legend: note }, (width) => {
        const left = 8,
            right = width - 14,
            px = (v) => left + scale.place(v) * (right - left);
        const top = 18,
            bottom = rows.length * tall + top;
        const marks = scale.marks(Math.max(2, Math.floor(width / 64)));
        const row = (r, i) => {
            const y = top + i * tall,
                at = y + 26,
                style = `c${r.index % colourCount}`;
            const text =
                `<text x="${left}" y="${y + 13}" class="name"><tspan
                    class="number">${escape(r.key)}</tspan>
                    ${escape(fitted(r.name, (width - 24) / 7 - r.text.length))}</text>` +
                `<text x="${right}" y="${y + 13}" text-anchor="end"
                    class="name">${escape(r.text)}</text>`;
            if (!Number.isFinite(r.value)) return text;
            const se = r.se || 0,
                whisker = (n) =>
                    line(
                        px(r.value - n * se).toFixed(1),
                        at,
                        px(r.value + n * se).toFixed(1),
                        at,
                        `bar ${style} sigma${n}`,
                    );
            const body = bars
                ? `<rect x="${Math.min(px(from), px(r.value)).toFixed(1)}"
                    width="${Math.abs(px(r.value) - px(from)).toFixed(1)}" y="${at - 6}" height="12"
                    class="body ${style}"/>`
                : "";
            return `<g class="point"><title>${escape(`${r.name}:
                ${r.text}`)}</title>${body}${whisker(2)}${whisker(1)}${
                bars
                    ? line(px(r.value), at - 7, px(r.value), at + 7, `bar ${style}`)
                    : mark(px(r.value), at, r, 4)
            }</g>${text}`;
        };
        return (
            marks
                .map(
                    ([v, text]) =>
                        line(px(v), top, px(v), bottom, "grid") +
                        label(px(v), bottom + 16, text + unit),
                )
                .join("") +
            lines
                .map(
                    ([v, text, style]) =>
                        line(px(v), top - 4, px(v), bottom, style) +
                        (text ? label(px(v), 10, text, px(v) > width / 2 ? "end" : "start") : ""),
                )
                .join("") +
            line(left, bottom, right, bottom, "axis") +
            rows.map(row).join("")
        );
    });
}
const fitted = (text, letters) =>
    text.length <= letters ? text : text.slice(0, Math.max(3, Math.floor(letters) - 1)) + "…";
