// SPDX-License-Identifier: Apache-2.0
// The page's head and its recommendation.

const badge = (c) =>
    `<span class="badge ${c.biased ? "biased" : "unbiased"}">${
        c.biased ? "biased" : "unbiased"
    }</span>`;
const nameOf = (c) =>
    `<span class="who"><b class="key c${c.index % colourCount}"` +
    `>${c.key}</b> ${escape(c.name)}</span>`;
const namedWithBias = (c) => `${nameOf(c)} ${badge(c)}`;
const relmseText = (v, se) => `${withError(v, se)}`;

const sizeText = (size) => (size ? `${size.join(" × ")} pixels` : "–");

function head() {
    const r = report.reference || {};
    const full = sizeText(report.resolution);
    const measured = sizeText(report.measured_resolution ?? report.resolution);
    const sizes = measured === full ? full : `${full}, measured at ${measured}`;
    const facts = {
        Budget: `${seconds(report.budget)}, of which ${seconds(report.seconds)} were used`,
        Reference: `unbiased, ${plural(r.samples ?? 0, "sample")} per pixel of
            ${plural(r.seeds ?? 1, "seed")}, ${seconds(r.seconds)}; its own relMSE is
            ${withError(r.relmse, r.relmse_se)} (${rms(r.relmse)} rms)`,
        Image: `${sizes}, ${plural(report.threads ?? 1, "thread")}`,
        "Made by": `woodcock ${escape(report.woodcock?.version ?? "")}:
            <code>${escape(report.command ?? "")}</code>`,
    };
    const notes = (report.notes || []).map((note) => `<li>${escape(note)}</li>`);
    return (
        `<h1>What each choice costs in ${escape(report.scene)}</h1>
        <dl class="facts">${Object.entries(facts)
            .map(([k, v]) => `<dt>${k}</dt><dd>${v}</dd>`)
            .join("")}</dl>` +
        (notes.length
            ? `<div class="notes" role="note"><h2>Notes</h2><ul>${notes.join("")}</ul></div>`
            : "")
    );
}

// ---- the command line to copy

// Lines break between words only.
const commandBox = (command) =>
    `<div class="command"><code tabindex="0">${command
        .split(" ")
        .map((word) => `<span>${escape(word)}</span>`)
        .join(" ")}</code><button type="button" class="copy">Copy</button></div>`;

async function copy(button) {
    const code = button.previousElementSibling;
    try {
        await navigator.clipboard.writeText(code.textContent);
    } catch {
        // Not every browser lets a file write to the clipboard.
        getSelection().selectAllChildren(code);
        document.execCommand("copy");
    }
    button.textContent = "Copied";
    setTimeout(() => {
        button.textContent = "Copy";
    }, 1500);
}

// ---- the answer to a time or an error

const rangeText = (kind, a, b) =>
    kind === "time"
        ? `${seconds(a)} to ${seconds(b)}`
        : `${number(a, 2)} to ${number(b, 2)} (${rms(a)} to ${rms(b)} rms)`;
const targetText = (kind, v) =>
    kind === "time" ? seconds(v) : `relMSE ${number(v, 2)} (${rms(v)} rms)`;

function expectation(kind, r, samples) {
    return kind === "time"
        ? `${plural(samples, "sample")} per pixel, expected relMSE ${relmseText(r.value, r.se)}
            (${rms(r.value)} rms)`
        : `${plural(samples, "sample")} per pixel, ${seconds(r.value)}${
              r.se > 0 ? ` ± ${seconds(r.se)}` : ""
          }`;
}

function answer() {
    const kind = settings.kind,
        at = settings.at[kind],
        chosen = choice(kind, at);
    if (!chosen)
        return `<p class="answer">For ${targetText(kind, target())}: <b>none${
            settings.unbiasedOnly ? " of the unbiased ones" : ""
        }</b>: ${
            kind === "time"
                ? "it is too short for one sample of every pixel."
                : "every one's bias alone exceeds it."
        }</p>`;
    const best = candidates[chosen.recommended],
        alike = [chosen.best, ...chosen.tied].filter((i) => i !== best.index),
        tied = ranking(kind, at).filter((r) => alike.includes(r.c.index)),
        unbiased = best.biased && choice(kind, at, true),
        without = unbiased && candidates[unbiased.recommended];
    const longest = Math.max(...(best.points || []).map((p) => p.samples), 0) || Infinity;
    const beyond = `<span class="soft">Measured up to ${plural(longest, "sample")}; what lies
        beyond follows from the model.</span>`;
    return (
        `<p class="answer">For ${targetText(kind, target())}: ${namedWithBias(best)}</p>
        <p>${expectation(kind, reached(best, kind, at), chosen.samples)}.
        ${chosen.samples > 4 * longest ? beyond : ""}</p>
        ${commandBox(commandFor(kind, best, chosen.samples))}` +
        (tied.length
            ? `<p>Cannot be told from it: ${tied.map((r) => namedWithBias(r.c)).join(", ")}.</p>`
            : "") +
        (without
            ? `<p>Best without bias: ${nameOf(without)},
                ${expectation(kind, reached(without, kind, at), unbiased.samples)}.</p>`
            : "")
    );
}

function rankingTable() {
    const kind = settings.kind,
        at = settings.at[kind],
        list = ranking(kind, at),
        unable = allowed().filter((c) => !list.some((r) => r.c === c)),
        best = list[0],
        most = list[list.length - 1],
        tied = choice(kind, at)?.tied;
    const share = (r) =>
        Math.max(
            0.02,
            1 -
                Math.log(most.value / r.value) /
                    Math.max(1e-9, Math.log(most.value / best.value) * 1.15),
        );
    return (
        `<table class="ranking"><caption>All of them ${
            kind === "time" ? "after" : "at"
        } ${targetText(kind, target())}</caption><thead><tr><th scope="col">Choice</th>
        <th scope="col">${kind === "time" ? "relMSE" : "time"}</th>
        <th scope="col"></th></tr></thead><tbody>` +
        list
            .map(
                (r) => `<tr><td>${nameOf(r.c)}</td><td>${
                    kind === "time" ? relmseText(r.value, r.se) : seconds(r.value)
                }</td>
            <td>${
                r === best
                    ? "<b>best</b>"
                    : tied.includes(r.c.index)
                      ? "tied"
                      : `× ${number(r.value / best.value, 3)}`
            }</td></tr>
            <tr class="share" aria-hidden="true"><td colspan="3"><i
            class="c${r.c.index % colourCount}"
            style="width:${(100 * share(r)).toFixed(1)}%"></i></td></tr>`,
            )
            .join("") +
        unable
            .map(
                (c) =>
                    `<tr><td>${nameOf(c)}</td><td colspan="2" class="soft">${
                        !c.variance
                            ? "not measured"
                            : kind === "time"
                              ? "too slow"
                              : "never: its bias"
                    }</td></tr>`,
            )
            .join("") +
        `</tbody></table>`
    );
}

// ---- which to take when

const steps = 1000;
const toSlider = (kind, v) => {
    const [a, b] = domain(kind).map(Math.log);
    return b > a ? (steps * (Math.log(v) - a)) / (b - a) : 0;
};
const fromSlider = (kind, p) => {
    const [a, b] = domain(kind).map(Math.log);
    return Math.exp(a + ((b - a) * p) / steps);
};

function strip(list, kind) {
    return list
        .map((s) => {
            const from = toSlider(kind, s.from) / steps,
                to = toSlider(kind, s.to) / steps;
            const text = s.c ? `${s.c.key} ${s.c.name}` : "none",
                title = `${text}: ${rangeText(kind, s.from, s.to)}`;
            return `<span class="${
                s.c ? `c${s.c.index % colourCount}${s.c.biased ? " biased" : ""}` : "nobody"
            }" style="flex:${Math.max(0, to - from).toFixed(4)} 1 0"
                    title="${escape(title)}">${
                        to - from > 0.04 ? (s.c ? s.c.key : "–") : ""
                    }</span>`;
        })
        .join("");
}

function whichToTake(list, kind) {
    const items = list
        .filter((s) => s.to > s.from)
        .map(
            (s) =>
                `<li><span class="range">${rangeText(kind, s.from, s.to)}</span><span>${
                    s.c ? namedWithBias(s.c) : "none"
                }</span></li>`,
        );
    return `<h3>Which to take when</h3><ul class="when">${items.join("")}</ul>`;
}

function ownRecommendations() {
    const list = (report.recommendations || []).filter((r) => candidates[r.candidate]);
    if (!list.length) return "";
    return `<h3>Recommendations at a glance</h3><ul class="glance">${list
        .map(
            (r, i) => `<li><p><button type="button" class="link"
                data-recommendation="${i}">${escape(targetText(r.kind, r.target))}</button>
                ${nameOf(candidates[r.candidate])} ${badge(candidates[r.candidate])} <span
                class="soft">${isNumber(r.samples) ? plural(r.samples, "sample") + ", " : ""}relMSE
                ${number(r.expected_relmse, 2)}</span></p>${commandBox(r.command)}</li>`,
        )
        .join("")}</ul>`;
}

/**
 * Fills the section; changed() is called after every change, with true when the chart's points
 * move.
 */
function choose(section, changed) {
    section.innerHTML = `<h2>Recommendation</h2><div class="card choose"><div class="controls">
        <div class="modes" role="group" aria-label="Asked for"><button type="button"
        data-kind="time">A time</button><button type="button" data-kind="error">An
        error</button></div>
        <label class="number"><span id="unit"></span><input type="number" id="target" step="any"
        min="0"></label>
        <label class="check"><input type="checkbox" id="unbiasedOnly"> unbiased ones
        only</label><label class="check"><input type="checkbox" id="loading"> count loading,
        too</label></div>
        <input type="range" id="slider" min="0" max="${steps}" step="1"><div class="strip"
        aria-hidden="true"></div><div class="ends soft"><span></span><span>by number: which to take
        there; striped: biased</span><span></span></div>
        <div class="columns"><div><div id="answer" aria-live="polite"></div>
        <div id="when"></div></div><div id="ranking" class="wide"></div></div></div>
        <div id="own">${ownRecommendations()}</div>`;
    const find = (id) => section.querySelector("#" + id),
        slider = find("slider"),
        field = find("target");
    const draw = (moved) => {
        const kind = settings.kind,
            list = segments(kind);
        for (const button of section.querySelectorAll("[data-kind]"))
            button.setAttribute("aria-pressed", button.dataset.kind === kind);
        find("unit").textContent = kind === "time" ? "seconds" : "relMSE";
        slider.setAttribute("aria-label", kind === "time" ? "time" : "error");
        slider.setAttribute("aria-valuetext", targetText(kind, target()));
        // What is being used is left alone until it is let go.
        if (document.activeElement !== slider) slider.value = toSlider(kind, target());
        if (document.activeElement !== field) field.value = target();
        section.querySelector(".strip").innerHTML = strip(list, kind);
        const ends = section.querySelectorAll(".ends span");
        ((ends[0].textContent =
            kind === "time" ? seconds(domain(kind)[0]) : number(domain(kind)[0], 2)),
            (ends[2].textContent =
                kind === "time" ? seconds(domain(kind)[1]) : number(domain(kind)[1], 2)));
        ((find("answer").innerHTML = answer()),
            (find("when").innerHTML = whichToTake(list, kind)),
            (find("ranking").innerHTML = rankingTable()));
        changed(moved);
    };
    section.addEventListener("input", (event) => {
        const { id } = event.target;
        const ask = (v) => (settings.at[settings.kind] = nearest(settings.kind, v));
        if (event.target === slider) ask(fromSlider(settings.kind, Number(slider.value)));
        else if (event.target === field) {
            if (!(Number(field.value) > 0)) return;
            ask(Number(field.value));
        } else settings[id] = event.target.checked;
        draw(id === "loading");
    });
    // What was typed gives way to what was answered.
    field.addEventListener("change", () => (field.value = target()));
    section.addEventListener("click", (event) => {
        const { kind, recommendation } = event.target.dataset;
        if (kind) settings.kind = kind;
        if (recommendation) {
            const r = report.recommendations.filter((x) => candidates[x.candidate])[recommendation];
            ((settings.kind = r.kind), (settings.at[r.kind] = nearest(r.kind, r.target)));
        }
        if (event.target.matches(".copy")) copy(event.target);
        if (kind || recommendation) draw();
    });
    draw();
}
