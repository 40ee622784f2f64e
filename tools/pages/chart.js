// SPDX-License-Identifier: Apache-2.0
// Charts of y against x, with series of points and lines, which tell of the point under the
// pointer or the arrow keys.

const colourCount = 7,
    shapes = ["circle", "square", "triangle", "diamond", "wedge"];

/**
 * The SVG of a series' mark around (x, y); hollow ones are filled with the card's colour. Colour
 * and shape go round at different lengths.
 */
function mark(x, y, { index, hollow }, radius = 4.5) {
    const r = radius,
        style = `mark c${index % colourCount}${hollow ? " hollow" : ""}`;
    const polygon = (points) =>
        `<polygon points="${points
            .map(([u, v]) => `${(x + u * r).toFixed(1)},${(y + v * r).toFixed(1)}`)
            .join(" ")}" class="${style}"/>`;
    switch (shapes[index % shapes.length]) {
        case "square":
            return polygon([
                [-0.9, -0.9],
                [0.9, -0.9],
                [0.9, 0.9],
                [-0.9, 0.9],
            ]);
        case "triangle":
            return polygon([
                [0, -1.2],
                [1.15, 0.85],
                [-1.15, 0.85],
            ]);
        case "diamond":
            return polygon([
                [0, -1.3],
                [1.3, 0],
                [0, 1.3],
                [-1.3, 0],
            ]);
        case "wedge":
            return polygon([
                [0, 1.2],
                [1.15, -0.85],
                [-1.15, -0.85],
            ]);
        default:
            return `<circle cx="${x.toFixed(1)}" cy="${y.toFixed(1)}" r="${r}" class="${style}"/>`;
    }
}
const swatch = (
    series,
) => `<svg class="swatch" viewBox="0 0 28 14" width="28" height="14" aria-hidden="true">
    ${line(
        1,
        7,
        27,
        7,
        `curve c${series.index % colourCount}${series.dashed ? " dashed" : ""}`,
    )}${mark(14, 7, series)}</svg>`;

const powerOfTen = (n) =>
    "10" + String(n).replace(/./g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]));

/**
 * An axis that has room for the values: maps them to [0, 1] and back, and gives about `count`
 * marks [value, text].
 */
function axis({ label, log }, values) {
    const scale = log ? Math.log10 : (v) => v,
        back = log ? (v) => Math.pow(10, v) : (v) => v;
    const known = values.filter((v) => Number.isFinite(v) && (!log || v > 0)).map(scale);
    let low = known.length ? Math.min(...known) : 0,
        high = known.length ? Math.max(...known) : 1;
    const room = high > low ? 0.05 * (high - low) : log ? 0.2 : 0.1 * Math.abs(high) || 1;
    ((low -= room), (high += room));
    const marks = (count) => {
        if (!log || high - low < 0.4)
            return ticks(back(low), back(high), count).map((v) => [v, number(v, 4)]);
        const decades = [];
        for (let step = Math.ceil((high - low) / count); step > 0 && decades.length < 2; --step) {
            decades.length = 0;
            for (let n = step * Math.ceil(low / step); n <= high; n += step) decades.push(n);
        }
        if (high - low > 1.7 && decades.length > 1) {
            const plain = decades.every((n) => n >= -4 && n <= 5);
            return decades.map((n) => [back(n), plain ? number(back(n)) : powerOfTen(n)]);
        }
        const list = [];
        for (let n = Math.floor(low); n <= high; ++n)
            for (const m of [1, 2, 5])
                if (Math.log10(m) + n >= low && Math.log10(m) + n <= high)
                    list.push(Number((m * Math.pow(10, n)).toPrecision(3)));
        return list.map((v) => [v, number(v, 3)]);
    };
    return {
        label,
        log,
        low,
        high,
        marks,
        place: (v) => (scale(v) - low) / (high - low),
        value: (p) => back(low + p * (high - low)),
    };
}

/**
 * Moves sorted places apart until neighbours are `apart` from one another, within [top, bottom].
 */
function spread(places, apart, top, bottom) {
    const list = [...places];
    for (let i = 0; i < list.length; ++i)
        list[i] = Math.max(list[i], i ? list[i - 1] + apart : top);
    for (let i = list.length - 1; i >= 0; --i)
        list[i] = Math.min(list[i], i < list.length - 1 ? list[i + 1] - apart : bottom);
    return list;
}

let chartCount = 0;

/**
 * A chart in a card. `x` and `y` are {label, log}; a series is {index, name, key, hollow, dashed,
 * points: [{x, y, se, text}], line: [[x, y]]}: points have bars of one standard error. `extent`
 * gives more x and y to make room for; behind(f) draws under the series. Returns {card, redraw}.
 */
function chart(
    parent,
    {
        title,
        x,
        y,
        series,
        height = 300,
        extent = { x: [], y: [] },
        behind = () => "",
        keys = false,
        legend = true,
        onToggle = () => {},
    },
) {
    const card = document.createElement("div"),
        id = `clip${chartCount++}`,
        hidden = new Set();
    card.className = "card chart";
    card.innerHTML =
        `<h3>${escape(title)}</h3><div class="drawing" tabindex="0" role="application"
            aria-roledescription="chart"
            aria-label="${escape(title)}. Arrow keys go from point to point."></div><div class="tip"
            hidden></div><p class="unseen" role="status"></p>` +
        (legend
            ? `<div class="keys" role="group" aria-label="Shown in ${escape(title)}">${series
                  .map(
                      (s, i) =>
                          `<button type="button" data-series="${i}"
                              aria-pressed="true">${swatch(s)}<span>${
                                  keys ? `<b>${escape(s.key)}</b> ` : ""
                              }${escape(s.name)}</span></button>`,
                  )
                  .join("")}</div>`
            : "");
    parent.append(card);
    const drawing = card.querySelector(".drawing"),
        tip = card.querySelector(".tip"),
        status = card.querySelector("[role=status]");
    const visible = () => series.filter((s) => !hidden.has(s));
    const xAxis = axis(x, [...series.flatMap((s) => s.points.map((p) => p.x)), ...extent.x]);
    const yAxis = axis(y, [
        ...series.flatMap((s) =>
            s.points.flatMap((p) => [p.y, p.y + (p.se || 0), p.y - Math.min(p.se || 0, 0.5 * p.y)]),
        ),
        ...extent.y,
    ]);
    let frame = null,
        chosen = null;

    const draw = (width) => {
        const right = width - (keys ? 24 : 10),
            left = 50,
            top = 22,
            bottom = height - 40;
        const px = (v) => left + xAxis.place(v) * (right - left),
            py = (v) => bottom - yAxis.place(v) * (bottom - top);
        // What is not positive goes below the frame.
        const least = yAxis.log ? Math.pow(10, yAxis.low - 1) : -Infinity;
        frame = { left, right, top, bottom, px, py: (v) => py(Math.max(v, least)), xAxis, yAxis };
        const xMarks = xAxis.marks(Math.max(2, Math.floor((right - left) / 60))),
            yMarks = yAxis.marks(Math.max(2, Math.floor((bottom - top) / 45)));
        // The last label must not run into what comes before it.
        let end = -Infinity;
        const xTexts = xMarks.map(([v, text]) => {
            const wide = 7 * text.length,
                at = px(v);
            if (at - wide / 2 < end + 4) return "";
            end = at + wide / 2;
            return label(at.toFixed(1), bottom + 16, text);
        });
        const curves = visible().map((s) =>
            s.line.length
                ? path(
                      s.line.map(([u, v]) => [px(u), frame.py(v)]),
                      `curve c${s.index % colourCount}${s.dashed ? " dashed" : ""}`,
                  )
                : "",
        );
        const bar = (s, p) =>
            p.se > 0
                ? line(
                      px(p.x).toFixed(1),
                      frame.py(p.y + p.se).toFixed(1),
                      px(p.x).toFixed(1),
                      frame.py(p.y - p.se).toFixed(1),
                      `bar c${s.index % colourCount}`,
                  )
                : "";
        const marks = visible().map((s) =>
            s.points
                .map((p) => `<g class="point">${bar(s, p)}${mark(px(p.x), frame.py(p.y), s)}</g>`)
                .join(""),
        );
        const ring =
            chosen && !hidden.has(chosen.series)
                ? `<circle cx="${px(chosen.point.x)}" cy="${frame.py(chosen.point.y)}" r="9"
                    class="ring"/>`
                : "";
        return (
            `<defs><clipPath id="${id}"><rect x="${left}" y="${top - 6}" width="${right - left}"
                height="${bottom - top + 6}"/></clipPath></defs>` +
            xMarks.map(([v]) => line(px(v), top, px(v), bottom, "grid")).join("") +
            yMarks
                .map(
                    ([v, text]) =>
                        line(left, py(v), right, py(v), "grid") +
                        label(left - 6, py(v) + 4, text, "end"),
                )
                .join("") +
            line(left, bottom, right, bottom, "axis") +
            xTexts.join("") +
            label((left + right) / 2, height - 4, xAxis.label) +
            label(0, 10, yAxis.label, "start") +
            `<g clip-path="url(#${id})">${behind(frame, visible())}` +
            `${curves.join("")}${marks.join("")}${ring}</g>` +
            (keys ? endKeys() : "")
        );
    };
    // The keys at the lines' right ends, moved apart.
    const endKeys = () => {
        const ends = visible()
            .filter((s) => s.line.length)
            .map((s) => ({ s, y: frame.py(s.line[s.line.length - 1][1]) }))
            .filter((e) => e.y <= frame.bottom + 4)
            .sort((a, b) => a.y - b.y);
        const places = spread(
            ends.map((e) => e.y),
            13,
            frame.top,
            frame.bottom,
        );
        return ends
            .map(
                (e, i) =>
                    `<text x="${frame.right + 6}" y="${places[i] + 4}"
                        class="end c${e.s.index % colourCount}">${escape(e.s.key)}</text>`,
            )
            .join("");
    };
    const redraw = () => {
        const width = Math.max(240, drawing.clientWidth);
        drawing.innerHTML = `<svg viewBox="0 0 ${width} ${height}" height="${height}"
            aria-hidden="true">${draw(width)}</svg>`;
    };

    const all = () => visible().flatMap((s) => s.points.map((point) => ({ series: s, point })));
    const show = (found) => {
        chosen = found;
        redraw();
        tip.hidden = !found;
        if (!found) return;
        const { series: s, point } = found,
            at = [frame.px(point.x), Math.min(frame.bottom, frame.py(point.y))];
        tip.innerHTML = `<b>${
            keys ? escape(s.key) + " " : ""
        }${escape(s.name)}</b><br>${point.text.map(escape).join("<br>")}`;
        status.textContent = `${s.name}: ${point.text.join(", ")}`;
        const room = card.clientWidth,
            wide = tip.offsetWidth,
            x0 = drawing.offsetLeft + at[0];
        tip.style.left = `${Math.max(
            4,
            Math.min(room - wide - 4, x0 + (x0 > room / 2 ? -wide - 14 : 14)),
        )}px`;
        tip.style.top = `${drawing.offsetTop + Math.max(0, at[1] - tip.offsetHeight - 8)}px`;
    };
    const nearest = (event) => {
        const box = drawing.getBoundingClientRect(),
            u = event.clientX - box.left,
            v = event.clientY - box.top;
        const apart = ({ point }) => Math.hypot(frame.px(point.x) - u, frame.py(point.y) - v),
            limit = event.pointerType === "mouse" ? 24 : 40;
        return (
            all()
                .filter((p) => apart(p) < limit)
                .sort((a, b) => apart(a) - apart(b))[0] || null
        );
    };
    const point = (event) => {
        const found = nearest(event);
        if (found?.point !== chosen?.point) show(found);
    };
    drawing.addEventListener("pointermove", point);
    drawing.addEventListener("pointerdown", point);
    drawing.addEventListener("pointerleave", (event) => {
        if (event.pointerType === "mouse") show(null);
    });
    drawing.addEventListener("blur", () => show(null));
    drawing.addEventListener("keydown", (event) => {
        const shown = visible().filter((s) => s.points.length);
        if (event.key === "Escape") show(null);
        const step = {
            ArrowLeft: [0, -1],
            ArrowRight: [0, 1],
            ArrowUp: [-1, 0],
            ArrowDown: [1, 0],
        }[event.key];
        if (!step || !shown.length) return;
        event.preventDefault();
        const s = shown.indexOf(chosen?.series),
            p = s < 0 ? -1 : chosen.series.points.indexOf(chosen.point);
        const next = shown[s < 0 ? 0 : (s + step[0] + shown.length) % shown.length];
        show({
            series: next,
            point: next.points[
                s < 0 ? 0 : Math.max(0, Math.min(next.points.length - 1, p + step[1]))
            ],
        });
    });
    card.querySelector(".keys")?.addEventListener("click", (event) => {
        const button = event.target.closest("[data-series]");
        if (!button) return;
        const s = series[button.dataset.series];
        hidden.has(s) ? hidden.delete(s) : hidden.add(s);
        button.setAttribute("aria-pressed", !hidden.has(s));
        if (chosen && hidden.has(chosen.series)) show(null);
        redraw();
        onToggle();
    });
    redraw();
    new ResizeObserver(redraw).observe(drawing);
    return { card, redraw };
}
