// SPDX-License-Identifier: Apache-2.0
// Plots of standard errors and of curves.

/** A frame with a scale of y on its left; returns the drawing, and maps. */
function frame(width, height, [low, high], unit = (v) => number(v, 3)) {
    const left = 52,
        right = width - 8,
        top = 8,
        bottom = height - 26;
    const y = (v) => bottom - ((v - low) / (high - low)) * (bottom - top);
    const marks = ticks(low, high, height > 200 ? 6 : 4);
    const svg =
        marks
            .map(
                (v) =>
                    line(left, y(v), right, y(v), "grid") +
                    label(left - 6, y(v) + 4, unit(v), "end"),
            )
            .join("") + line(left, bottom, right, bottom, "axis");
    return { left, right, top, bottom, y, svg };
}

/** A point: a disc where it passes, a square standing on its corner where not. */
function mark(x, y, c, style = `mark-${c.verdict}`, radius = 3) {
    const shape =
        c.verdict === "pass"
            ? `<circle cx="${x}" cy="${y}" r="${radius}"`
            : `<path d="M${x - 6} ${y}L${x} ${y - 6}L${x + 6} ${y}L${x} ${y + 6}Z"`;
    const title = `${c.name}\nexpected ${figure(c.expected)}, measured ${figure(c.measured)},
        standard error ${number(c.standardError, 2)}, z ${number(c.z, 3)}`;
    return `${shape} class="${style}"><title>${escape(title)}</title></${
        c.verdict === "pass" ? "circle" : "path"
    }>`;
}

const radiusFor = (list) => (list.length > 150 ? 2 : 3);
const across = (f, n) => (i) => f.left + ((i + 0.5) / n) * (f.right - f.left);

function standardErrors(list) {
    return (width, height) => {
        const most = 5.5,
            f = frame(width, height, [-most, most]),
            x = across(f, list.length);
        return (
            `<rect x="${f.left}" y="${f.y(1)}" width="${f.right - f.left}"
                height="${f.y(-1) - f.y(1)}" class="band"/>` +
            f.svg +
            line(f.left, f.y(0), f.right, f.y(0), "zero") +
            [-largestZ, largestZ]
                .map((z) => line(f.left, f.y(z), f.right, f.y(z), "limit"))
                .join("") +
            list
                .map((c, i) =>
                    mark(
                        x(i),
                        f.y(Math.max(-most, Math.min(most, c.z))),
                        c,
                        undefined,
                        radiusFor(list),
                    ),
                )
                .join("") +
            label((f.left + f.right) / 2, height - 6, "cases, in the table's order")
        );
    };
}

function relative(list) {
    const reach = list
        .map((c) => (Math.abs(difference(c)) + 4 * c.standardError) / Math.abs(c.expected))
        .sort((a, b) => a - b);
    // Those with large errors, and those next to zero, must not flatten all others.
    const most = Math.min(0.1, Math.max(reach[Math.floor(0.9 * (reach.length - 1))] * 1.1, 1e-15));
    return (width, height) => {
        const f = frame(width, height, [-most, most], (v) => number(100 * v, 2) + " %"),
            x = across(f, list.length);
        const clip = (v) => Math.max(-most, Math.min(most, v));
        const bar = (c, i, n, style) => {
            const d = difference(c) / c.expected,
                e = (n * c.standardError) / Math.abs(c.expected);
            return line(
                x(i),
                f.y(clip(d - e)),
                x(i),
                f.y(clip(d + e)),
                `mark-${c.verdict} ${style}`,
            );
        };
        return (
            f.svg +
            line(f.left, f.y(0), f.right, f.y(0), "zero") +
            list
                .map(
                    (c, i) =>
                        bar(c, i, 4, "wide") +
                        bar(c, i, 1, list.length > 150 ? "" : "near") +
                        mark(
                            x(i),
                            f.y(clip(difference(c) / c.expected)),
                            c,
                            undefined,
                            radiusFor(list),
                        ),
                )
                .join("") +
            label((f.left + f.right) / 2, height - 6, "cases, in the table's order")
        );
    };
}

function errorPlots(section) {
    section.innerHTML = `<h2>Differences from theory</h2>
        <p class="soft">First the difference over its standard error: two thirds should lie in the
        band, and none beyond the dashed lines. Then the difference relative to theory, with bars of
        one (thick) and four (thin) standard errors; bars that leave the plot are cut. Cases without
        random numbers are in the table only, as are, in the second plot, those within 20 standard
        errors of zero.</p><div class="plots"></div>`;
    let any = false;
    for (const kind of kinds) {
        const list = cases.filter((c) => c.kind === kind && random(c)),
            scaled = list.filter((c) => c.standardError < 0.05 * Math.abs(c.expected));
        if (list.length)
            ((any = true),
                plot(
                    section.lastElementChild,
                    `${kind}: standard errors off`,
                    {
                        height: 240,
                        label: `${kind}: difference over standard error of
                            ${plural(list.length, "case")}`,
                    },
                    standardErrors(list),
                ));
        if (scaled.length)
            plot(
                section.lastElementChild,
                `${kind}: relative difference`,
                {
                    height: 240,
                    label: `${kind}: relative difference of ${plural(scaled.length, "case")}, with
                        error bars`,
                },
                relative(scaled),
            );
    }
    section.hidden = !any;
}

function histogram(section) {
    // An allowance that shows would bend the distribution.
    const list = cases.filter((c) => random(c) && c.allowance < 0.1 * c.standardError);
    section.hidden = list.length < 10;
    section.innerHTML = `<h2>Distribution of z</h2><p class="soft">Of the ${list.length} cases whose
        expectation is exact by comparison, against the normal curve that independent samples would
        follow. Quasi-random points err less than their standard error says, which makes it
        narrower.</p><div class="plots"></div>`;
    const bins = 22,
        lowest = -5.5,
        wide = 0.5,
        counts = new Array(bins).fill(0);
    for (const c of list)
        ++counts[
            Math.max(
                0,
                Math.min(bins - 1, Math.floor((difference(c) / c.standardError - lowest) / wide)),
            )
        ];
    const normal = (z) => (list.length * wide * Math.exp((-z * z) / 2)) / Math.sqrt(2 * Math.PI);
    plot(
        section.lastElementChild,
        "Cases by z",
        { height: 280, label: "Histogram of z against the normal curve" },
        (width, height) => {
            const f = frame(width, height, [0, 1.1 * Math.max(normal(0), ...counts)]);
            const x = (z) => f.left + ((z - lowest) / (bins * wide)) * (f.right - f.left);
            const curve = Array.from(
                { length: 111 },
                (_, i) => `${x(lowest + i / 10)},${f.y(normal(lowest + i / 10))}`,
            );
            return (
                f.svg +
                counts
                    .map((n, i) =>
                        n
                            ? `<rect x="${x(lowest + i * wide) + 1}" width="${x(wide) - x(0) - 2}"
                                y="${f.y(n)}" height="${f.bottom - f.y(n)}"
                                class="bar"><title>${plural(n, "case")}</title></rect>`
                            : "",
                    )
                    .join("") +
                `<polyline points="${curve.join(" ")}" class="theory"/>` +
                [-4, -2, 0, 2, 4].map((z) => label(x(z), height - 8, number(z))).join("")
            );
        },
    );
}

/** Curves "A at P" and "B at P" share a plot, which is called P. */
function curvePlots(section) {
    const panels = new Map();
    for (const c of cases.filter((c) => c.curve && Number.isFinite(c.measured))) {
        const at = c.curve.indexOf(" at "),
            series = at < 0 ? c.curve : c.curve.slice(0, at),
            panel = at < 0 ? c.curve : c.curve.slice(at + 4);
        if (!panels.has(panel)) panels.set(panel, new Map());
        const all = panels.get(panel);
        if (!all.has(series)) all.set(series, []);
        all.get(series).push(c);
    }
    section.innerHTML = `<h2>Curves</h2><p class="soft">Theory as a line from point to point,
        measurements with bars of four standard errors; where no bar is seen, it is smaller than the
        point. Curves of a single point are in the table only.</p>
        <div class="plots small"></div>`;
    let any = false;
    for (const [panel, all] of panels) {
        const list = [...all.values()].flat(),
            xs = list.map((c) => c.x),
            least = Math.min(...xs),
            largest = Math.max(...xs);
        if (!(largest > least)) continue;
        any = true;
        const logarithmic = least > 0 && largest / least > 5,
            scale = (v) => (logarithmic ? Math.log10(v) : v);
        const a = scale(least),
            b = scale(largest),
            pad = 0.06 * (b - a);
        const ends = list.flatMap((c) => [
            c.expected,
            c.measured - 4 * c.standardError,
            c.measured + 4 * c.standardError,
        ]);
        const low = Math.min(0, ...ends),
            high = Math.max(...ends),
            room = 0.06 * (high - low || 1);
        const legend = `${[...all.keys()]
            .map((name, i) => `<i${i % 2 ? ' class="second"' : ""}></i>${escape(name)}`)
            .join("")}
            <span>against ${escape(list[0].x_name)}</span>`;
        plot(
            section.lastElementChild,
            panel,
            {
                height: 190,
                label: `${[...all.keys()].join(" and ")} against ${list[0].x_name}, at ${panel}`,
                legend,
            },
            (width, height) => {
                const f = frame(width, height, [low < 0 ? low - room : 0, high + room]);
                const x = (v) =>
                    f.left + ((scale(v) - a + pad) / (b - a + 2 * pad)) * (f.right - f.left);
                const steps = logarithmic
                    ? ticks(
                          Math.ceil(a - 0.05),
                          Math.floor(b + 0.05),
                          Math.min(3, Math.max(1, Math.floor(b + 0.05) - Math.ceil(a - 0.05))),
                      )
                          .filter(Number.isInteger)
                          .map((v) => Math.pow(10, v))
                    : ticks(least, largest, 3);
                const marks = steps.length > 1 ? steps : [least, largest];
                const seriesSvg = [...all.values()]
                    .map((cs, i) => {
                        const sorted = [...cs].sort((p, q) => p.x - q.x);
                        const expected = sorted.map((c) => `${x(c.x)},${f.y(c.expected)}`);
                        return (
                            `<polyline class="line${i % 2}" points="${expected.join(" ")}"/>` +
                            sorted
                                .map(
                                    (c) =>
                                        line(
                                            x(c.x),
                                            f.y(c.measured - 4 * c.standardError),
                                            x(c.x),
                                            f.y(c.measured + 4 * c.standardError),
                                            `series${i % 2}`,
                                        ) +
                                        mark(
                                            x(c.x),
                                            f.y(c.measured),
                                            c,
                                            c.verdict === "pass" ? `series${i % 2}` : undefined,
                                        ),
                                )
                                .join("")
                        );
                    })
                    .join("");
                return (
                    f.svg +
                    seriesSvg +
                    marks.map((v) => label(x(v), height - 8, number(v, 3))).join("")
                );
            },
        );
    }
    section.hidden = !any;
}
