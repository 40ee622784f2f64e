// SPDX-License-Identifier: Apache-2.0
// Verdicts, tables and plots, and the page's beginning.

function summary() {
    const differing = report.comparisons.filter((c) => c.verdict === "differ").map((c) => c.image),
        a = letters[0];
    const title = differing.length
        ? `<h1 class="bad">${differing.join(", ")} differ${
              differing.length === 1 ? "s" : ""
          } from ${a}</h1>`
        : `<h1 class="good">${letters.slice(1).join(", ")} and ${a}: same within noise</h1>`;
    const files = report.images.map((image, i) => {
        const facts = [
            i === 0 && "the reference",
            image.made_by,
            image.samples && plural(image.samples, "sample"),
            image.render_seconds && `${number(image.render_seconds, 3)} s`,
            image.errors_from && `standard errors from ${image.errors_from}`,
        ].filter(Boolean);
        return `<li><b>${image.letter}</b> ${image.files.map(escape).join(", ")} <span
            class="soft">${escape(facts.join(", "))}</span></li>`;
    });
    const verdicts = report.comparisons.map(
        (c) => `<p>${c.image}: <b class="${
            c.verdict === "differ" ? "bad" : "good"
        }">${c.verdict}</b>${c.reason ? `: ${escape(c.reason)}` : ""}.
        <span class="soft">${plural(c.tests, "test")} of means, over ${plural(report.tiles, "tile")}
        and the whole of each channel; noise from ${c.noise_from}; images of equal expectation are
        said to differ with probability ${number(report.false_alarm_rate)}.</span></p>`,
    );
    return (
        title +
        `<ul class="files">${files.join("")}</ul>` +
        verdicts.join("") +
        `<p class="soft">${report.width} × ${report.height}
            pixels.${report.notes.map((n) => `<br>${escape(n)}`).join("")}</p>`
    );
}

// ---- tables

const columns = [
    ["Channel", (c) => escape(c.name) + (c.tested ? "" : " (not tested)")],
    ["mean A", (c) => number(c.mean.reference)],
    ["mean", (c) => number(c.mean.image)],
    ["ratio", (c) => `${number(c.ratio, 6)} ± ${number(c.ratio_error, 2)}`],
    ["bias", (c) => `${number(c.bias, 3)} ± ${number(c.bias_error, 2)}`],
    ["z", (c) => number(c.bias ? c.bias / c.bias_error : 0, 3)],
    ["RMSE", (c) => number(c.rmse, 3)],
    ["relMSE", (c) => number(c.relmse, 3)],
    ["PSNR", (c) => (c.psnr === null ? "∞" : number(c.psnr, 3))],
    [
        "NaN or infinite",
        (c) =>
            c.non_finite.reference + c.non_finite.image
                ? `${c.non_finite.reference} | ${c.non_finite.image}`
                : "0",
    ],
];

const channelRow = (channel) =>
    `<tr>${columns.map(([, text]) => `<td>${text(channel)}</td>`).join("")}</tr>`;

function largestList(c, right) {
    const places = new Map();
    for (const channel of c.channels)
        for (const d of channel.largest) {
            const key = `${d.x},${d.y}`,
                size = Math.abs(d.image - d.reference);
            if (!places.has(key) || places.get(key).size < size)
                places.set(key, { ...d, size, name: channel.name });
        }
    const list = [...places.values()].sort((p, q) => q.size - p.size).slice(0, 5);
    const link = (x, y, text) =>
        `<button type="button" class="link" data-x="${x}" data-y="${y}"
            data-right="${right}">${text}</button>`;
    const tiles = c.worst_tiles.slice(0, 5).map(
        (t) =>
            `${link(
                (t.x0 + t.x1 - 1) >> 1,
                (t.y0 + t.y1 - 1) >> 1,
                `[${t.x0}, ${t.x1}) ×
                    [${t.y0}, ${t.y1})`,
            )} ${escape(t.channel)} ${number(t.difference, 3)} ±
                        ${number(t.error, 2)}`,
    );
    return (
        (list.length
            ? `<p>Largest differences: ${list
                  .map(
                      (d) => `${link(d.x, d.y, `${d.x}, ${d.y}`)}
                ${escape(d.name)} ${number(d.image - d.reference, 3)}`,
                  )
                  .join("; ")}.</p>`
            : "") + (tiles.length ? `<p>Least likely tiles: ${tiles.join("; ")}.</p>` : "")
    );
}

function tables(section) {
    section.innerHTML =
        `<h2>Metrics</h2><p class="soft">relMSE is the mean of (image − A)² / (A² +
            ${report.relmse_epsilon}). PSNR is relative to the largest value of A. ± is one standard
            error. FLIP is of scene-linear Rec.709, clipped at 1 (LDR) or over all exposures (HDR),
            at 67 pixels per degree.</p>` +
        report.comparisons
            .map(
                (c, i) => `<h3>${c.image} against ${letters[0]}</h3>
        <div class="wide"><table><thead><tr>${columns
            .map(([name]) => `<th scope="col">${name === "mean" ? `mean ${c.image}` : name}</th>`)
            .join("")}</tr></thead>
        <tbody>${c.channels.map(channelRow).join("")}</tbody></table></div> ${
            c.flip
                ? `<p>Mean FLIP ${number(c.flip.ldr, 4)}, HDR-FLIP ${number(c.flip.hdr, 4)}.</p>`
                : ""
        }${largestList(c, i + 1)}`,
            )
            .join("");
    section.addEventListener("click", (event) => {
        const { x, y, right } = event.target.dataset;
        if (x) goTo(x - report.x0, y - report.y0, 24 * devicePixelRatio, Number(right));
    });
}

// ---- plots

/** Counts as a stairs' outline. */
function stairs(counts, x, y) {
    const points = [[x(0), y(0)]];
    counts.forEach((n, i) => points.push([x(i), y(n)], [x(i + 1), y(n)]));
    points.push([x(counts.length), y(0)]);
    return points;
}

const bins = 64;
function countIn(values, place) {
    const counts = new Array(bins).fill(0);
    for (const v of values) {
        const i = place(v);
        if (i >= 0 && i < bins) ++counts[Math.floor(i)];
    }
    return counts;
}

function valueHistogram(section, c, a, b) {
    const of = (image) => images[image].subarray(c * pixelCount, (c + 1) * pixelCount);
    const ends = [a, b]
        .map((i) => sortedSome(of(i)).filter((v) => v > 0))
        .filter((sorted) => sorted.length);
    if (!ends.length) return;
    const low = Math.min(...ends.map((s) => Math.log2(s[Math.floor(0.001 * s.length)]))) - 0.1;
    const high = Math.max(low + 0.2, ...ends.map((s) => Math.log2(s[s.length - 1]) + 0.1));
    const place = (v) => (v > 0 ? ((Math.log2(v) - low) / (high - low)) * bins : -1),
        counts = [a, b].map((i) => countIn(of(i), place)),
        most = Math.max(1, ...counts.flat());
    plot(
        section,
        `${channels[c]}: values`,
        {
            legend: `<span><i></i>${letters[a]}</span><span><i
                class="b"></i>${letters[b]}</span><span>pixels (logarithmic) by stops</span>`,
        },
        (w, h) => {
            const x = (i) => 8 + (i / bins) * (w - 16),
                y = (n) => h - 24 - (Math.log1p(n) / Math.log1p(most)) * (h - 32);
            const marks = [0, 1, 2, 3].map((i) => low + ((i + 0.5) / 4) * (high - low));
            return (
                line(8, h - 24, w - 8, h - 24, "axis") +
                path(stairs(counts[0], x, y), "a") +
                path(stairs(counts[1], x, y), "b") +
                marks
                    .map((m) =>
                        label(
                            x(((m - low) / (high - low)) * bins),
                            h - 6,
                            number(Math.pow(2, m), 2),
                        ),
                    )
                    .join("")
            );
        },
    );
}

function differenceHistogram(section, c, a, b) {
    const d = differences(a, b, c, false),
        reach = usualSize(d) * 1.5;
    let n = 0,
        sum = 0,
        squares = 0;
    for (const v of d) if (Math.abs(v) <= reach) (++n, (sum += v), (squares += v * v));
    const mean = sum / n,
        deviation = Math.sqrt(squares / n - mean * mean);
    const counts = countIn(d, (v) => ((v / reach + 1) / 2) * bins),
        normal = (v) =>
            ((n * ((2 * reach) / bins)) / (deviation * Math.sqrt(2 * Math.PI))) *
            Math.exp(-0.5 * Math.pow((v - mean) / deviation, 2));
    const most = Math.max(
        1,
        ...counts,
        deviation > 0 ? Math.min(normal(mean), 2 * Math.max(...counts)) : 0,
    );
    plot(
        section,
        `${channels[c]}: ${letters[b]} − ${letters[a]}`,
        {
            legend: `<span><i></i>pixels (logarithmic)</span><span><i
                class="theory"></i>normal curve of the same width</span>`,
        },
        (w, h) => {
            const x = (i) => 8 + (i / bins) * (w - 16),
                y = (v) =>
                    h -
                    24 -
                    (Math.min(Math.log1p(v), Math.log1p(most)) / Math.log1p(most)) * (h - 32);
            const curve = Array.from({ length: 129 }, (_, i) => [
                x(i / 2),
                y(normal((i / 64 - 1) * reach)),
            ]);
            return (
                line(8, h - 24, w - 8, h - 24, "axis") +
                line(x(bins / 2), 4, x(bins / 2), h - 24, "grid") +
                path(stairs(counts, x, y), "a") +
                (deviation > 0 ? path(curve, "theory") : "") +
                [-1, 0, 1]
                    .map((m) =>
                        label(
                            x(((m + 1) / 2) * bins),
                            h - 6,
                            number(m * reach, 2),
                            m < 0 ? "start" : m ? "end" : "middle",
                        ),
                    )
                    .join("")
            );
        },
    );
}

function histograms(section) {
    section.innerHTML = `<h2>Histograms</h2><div class="plots"></div>`;
    for (let b = 1; b < letters.length; ++b)
        channels.forEach((_, c) => {
            valueHistogram(section.lastElementChild, c, 0, b);
            differenceHistogram(section.lastElementChild, c, 0, b);
        });
}

/** Error against samples or seconds, both logarithmic. */
function convergencePlot(section, points, unit) {
    const xs = points.map((p) => Math.log2(p.x)),
        ys = points.map((p) => Math.log2(p.y));
    const x0 = Math.min(...xs) - 0.3,
        x1 = Math.max(...xs) + 0.3,
        y0 = Math.min(...ys) - 0.5,
        y1 = Math.max(...ys) + 0.5,
        first = points[0];
    plot(
        section,
        `RMSE against ${unit}`,
        {
            legend: `<span>points: images against ${letters[0]}</span><span><i
                class="theory"></i>as the square root of ${unit}</span>`,
        },
        (w, h) => {
            const x = (v) => 56 + ((Math.log2(v) - x0) / (x1 - x0)) * (w - 72),
                y = (v) => h - 28 - ((Math.log2(v) - y0) / (y1 - y0)) * (h - 40);
            const expected = (v) => first.y * Math.sqrt(first.x / v),
                ends = [points[0].x, points[points.length - 1].x];
            const marks = [...new Set(points.map((p) => p.x))];
            return (
                line(56, h - 28, w - 8, h - 28, "axis") +
                path(
                    ends.map((v) => [x(v), y(expected(v))]),
                    "theory",
                ) +
                path(
                    points.map((p) => [x(p.x), y(p.y)]),
                    "b",
                ) +
                points
                    .map(
                        (p) =>
                            `<circle cx="${x(p.x)}" cy="${y(p.y)}" r="4"/>` +
                            label(x(p.x) + 7, y(p.y) - 6, p.letter, "start"),
                    )
                    .join("") +
                marks.map((v) => label(x(v), h - 8, number(v, 3))).join("") +
                [Math.min(...points.map((p) => p.y)), Math.max(...points.map((p) => p.y))]
                    .map((v) => label(50, y(v) + 4, number(v, 2), "end"))
                    .join("")
            );
        },
    );
}

function convergence(section) {
    section.innerHTML = `<h2>Convergence</h2><p class="soft">RMSE over the channels shown. Against a
        noisy reference it cannot fall below that one's noise.</p><div class="plots"></div>`;
    section.hidden = true;
    for (const [key, unit] of [
        ["samples", "samples"],
        ["render_seconds", "seconds"],
    ]) {
        const points = report.comparisons
            .map((c, i) => {
                const own = c.channels.filter((x) => channels.includes(x.name));
                return {
                    x: report.images[i + 1][key],
                    y: Math.sqrt(own.reduce((s, x) => s + x.rmse * x.rmse, 0) / own.length),
                    letter: c.image,
                };
            })
            .filter((p) => p.x > 0 && p.y > 0)
            .sort((p, q) => p.x - q.x);
        if (new Set(points.map((p) => p.x)).size < 2) continue;
        section.hidden = false;
        convergencePlot(section.lastElementChild, points, unit);
    }
}

// ---- the page

async function start() {
    main.innerHTML = "";
    section((s) => {
        s.innerHTML = summary();
    });
    let drawn = true;
    try {
        await unpackAll();
    } catch (error) {
        drawn = false;
        section((s) => {
            s.innerHTML = `<p class="bad">The images cannot be shown: ${escape(error.message)}.
                Browsers since 2023 can.</p>`;
        });
    }
    if (drawn) section(viewer);
    section(tables);
    section(convergence);
    if (drawn) section(histograms);
    keepPlots();
    document.documentElement.dataset.ready = drawn;
}
start();
