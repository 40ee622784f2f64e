// SPDX-License-Identifier: Apache-2.0
// What the scripts of all pages share: text, tables, and plots of any kind.

const dataOf = (id) => JSON.parse(document.getElementById(id).textContent);
const escape = (text) => String(text).replace(/[&<>"']/g, (c) => `&#${c.charCodeAt(0)};`);
const plural = (n, word) => `${n} ${word}${n === 1 ? "" : "s"}`;

const isNumber = (v) => typeof v === "number" && Number.isFinite(v);

/** A number to read; what is missing is a dash. */
const number = (v, digits = 5) => {
    if (v === null || v === undefined || Number.isNaN(v)) return "–";
    if (Math.abs(v) === Infinity) return v < 0 ? "−∞" : "∞";
    const tiny = v !== 0 && (Math.abs(v) < 1e-4 || Math.abs(v) >= 1e7);
    const text = tiny
        ? v
              .toExponential(digits - 1)
              .replace(/\.?0*e/, "e")
              .replace("e+", "e")
        : String(Number(v.toPrecision(digits)));
    return text.replaceAll("-", "−");
};

const main = document.getElementById("main");
function section(fill) {
    const s = document.createElement("section");
    main.append(s);
    fill(s);
}

// ---- tables: a column has a name, the text or html of a row, the key to sort by, and a class for
// its cells

function table(rows, columns, sort) {
    const head = columns.map((c, i) => {
        const order =
            sort && sort.column === c
                ? ` aria-sort="${sort.down ? "descending" : "ascending"}"`
                : "";
        const name = escape(c.name),
            title = sort ? `<button type="button" data-column="${i}">${name}</button>` : name;
        return `<th scope="col" class="${c.cell || ""}"${order}>${title}</th>`;
    });
    const cell = (c, row) =>
        `<td class="${c.cell || ""} ${c.mood ? c.mood(row) : ""}"
            data-label="${escape(c.name)}">${c.html ? c.html(row) : escape(c.text(row))}</td>`;
    const body = rows.map((row) => `<tr>${columns.map((c) => cell(c, row)).join("")}</tr>`);
    return `<table><thead><tr>${head.join("")}</tr></thead><tbody>${body.join("")}</tbody></table>`;
}

/**
 * Keeps a table of rows() in the box, sorted by the heading that was pressed last; what has no key
 * comes last. Returns what draws it anew.
 */
function sortableTable(box, rows, columns, sort, otherwise = () => 0) {
    const missing = (k) => k === null || k === undefined || Number.isNaN(k);
    const compare = (a, b) =>
        missing(a) || missing(b)
            ? missing(a) - missing(b)
            : (sort.down ? -1 : 1) * (a < b ? -1 : a > b ? 1 : 0);
    const draw = () => {
        const sorted = [...rows()].sort(
            (a, b) => compare(sort.column.key(a), sort.column.key(b)) || otherwise(a, b),
        );
        box.innerHTML = table(sorted, columns, sort);
    };
    box.addEventListener("click", (event) => {
        const chosen = event.target.dataset.column;
        if (chosen === undefined) return;
        sort.down = sort.column === columns[chosen] && !sort.down;
        sort.column = columns[chosen];
        draw();
        box.querySelector(`[data-column="${chosen}"]`).focus();
    });
    draw();
    return draw;
}

// ---- plots: each is drawn at the width that it has, so that letters keep their size

const plots = [];

/** A card with a plot, which draw(width, height) gives as SVG; the legend is HTML. */
function plot(parent, title, { height = 200, label = title, legend = "" }, draw) {
    const card = document.createElement("div");
    card.className = "card";
    card.innerHTML = `<h3>${escape(title)}</h3><div></div>${
        legend && `<p class="legend">${legend}</p>`
    }`;
    parent.append(card);
    plots.push({ box: card.children[1], height, label, draw });
}
function drawPlots() {
    for (const { box, height, label, draw } of plots) {
        const width = Math.max(200, box.clientWidth);
        box.innerHTML = `<svg viewBox="0 0 ${width} ${height}" height="${height}" role="img"
            aria-label="${escape(label)}">${draw(width, height)}</svg>`;
    }
}

/** Draws all plots, now and whenever the page's width changes. */
function keepPlots() {
    drawPlots();
    new ResizeObserver(drawPlots).observe(main);
}

const line = (x0, y0, x1, y1, style) =>
    `<line x1="${x0}" y1="${y0}" x2="${x1}" y2="${y1}" class="${style}"/>`;
const label = (x, y, text, anchor = "middle") =>
    `<text x="${x}" y="${y}" text-anchor="${anchor}">${escape(text)}</text>`;
const path = (points, style) =>
    `<polyline points="${points.map((p) => p.map((v) => v.toFixed(1)).join(",")).join(" ")}"
        class="${style}"/>`;

/** About `count` round numbers from a to b. */
function ticks(a, b, count) {
    const raw = (b - a) / count,
        power = Math.pow(10, Math.floor(Math.log10(raw)));
    const step = [1, 2, 5, 10].find((m) => m * power >= raw * 0.999) * power;
    const list = [];
    for (let i = Math.ceil(a / step - 1e-9); i * step <= b + step * 1e-9; ++i)
        list.push(Number((i * step).toPrecision(12)));
    return list;
}
