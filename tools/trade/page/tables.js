// SPDX-License-Identifier: Apache-2.0
// The candidates, and their readings at equal time and at equal error.

/** What halving the error costs: variance x seconds; less is better. */
const effort = (c) => answers.cost[c.index];

const candidateColumns = [
    {
        name: "Choice",
        key: (c) => c.index,
        html: (c) =>
            `${nameOf(c)}${
                c.quality ? ` <span class="badge">${escape(c.quality)}</span>` : ""
            }<small>${(c.choices || []).map(escape).join(" ") || "as the scene says"}</small>`,
        cell: "first",
    },
    { name: "Bias", key: (c) => Number(c.biased), html: badge },
    {
        name: "Front",
        key: (c) => Number(!c.front),
        text: (c) => (c.front ? "on it" : ""),
        cell: "middle",
    },
    {
        name: "Time per sample",
        key: (c) => valueOf(c.seconds_per_sample),
        html: (c) => msWithError(c.seconds_per_sample),
    },
    {
        name: "Processor time",
        key: (c) => valueOf(c.cpu_seconds_per_sample),
        html: (c) => msWithError(c.cpu_seconds_per_sample),
    },
    {
        name: "Variance",
        key: (c) => valueOf(c.variance),
        text: (c) => withError(c.variance?.value, c.variance?.se),
    },
    { name: "Variance × s", key: effort, text: (c) => number(effort(c), 3) },
    {
        name: "Bias of the mean",
        key: (c) => Math.abs(valueOf(c.bias)),
        text: (c) => withError(c.bias?.value, c.bias?.se, 100, " %"),
    },
    { name: "rms bias", key: (c) => valueOf(c.rms_bias), text: (c) => rmsBiasText(c) },
    { name: "Memory", key: (c) => c.memory, text: (c) => bytes(c.memory) },
    { name: "Loading", key: (c) => c.load_seconds, text: (c) => seconds(c.load_seconds) },
    { name: "Paper", key: (c) => c.paper || null, text: (c) => c.paper || "", cell: "left" },
];
const msWithError = (m) => escape(withError(m?.value, m?.se, 1000, " ms"));

function candidateTable(section) {
    section.innerHTML = `<h2>The choices</h2><p class="soft">Press a heading to sort. Variance is
        that of one sample, relative; variance × seconds is what an error costs: half of it is the
        same error in half the time.</p><div class="wide"></div>
        <details><summary>Their command lines</summary>${candidates
            .map((c) => `<p>${nameOf(c)}</p>${commandBox(c.command || "")}`)
            .join("")}</details>`;
    sortableTable(
        section.querySelector(".wide"),
        () => candidates,
        candidateColumns,
        { column: candidateColumns[0], down: false },
        (a, b) => a.index - b.index,
    );
    section.addEventListener("click", (event) => {
        if (event.target.matches(".copy")) copy(event.target);
    });
}

/** Rows of candidates against columns of readings. */
function readings(title, text, list, heading, cell) {
    if (!list?.length) return "";
    const shown = candidates.filter((c) =>
        list.some((e) => e.rows.some((r) => r.candidate === c.index)),
    );
    const columns = [
        { name: "Choice", html: nameOf, cell: "first" },
        ...list.map((e) => ({
            name: heading(e),
            html: (c) => {
                const row = e.rows.find((r) => r.candidate === c.index),
                    tied = (e.tied || []).includes(c.index);
                if (!row) return "–";
                return `${
                    e.best === c.index
                        ? `<b class="mood">best</b> `
                        : tied
                          ? `<span class="mood">tied</span> `
                          : ""
                }${cell(row)}`;
            },
            mood: (c) =>
                e.best === c.index ? "best" : (e.tied || []).includes(c.index) ? "tied" : "",
        })),
    ];
    return `<h2>${title}</h2><p class="soft">${text}</p>
        <div class="wide">${table(shown, columns)}</div>`;
}

function equalTime(section) {
    section.innerHTML = readings(
        "At equal time",
        "relMSE after so many seconds; below it FLIP and the samples per pixel. " +
            "Tied: these measurements do not tell it from the best.",
        report.equal_time,
        (e) => seconds(e.seconds),
        (r) =>
            `${withError(r.relmse, r.relmse_se)}<small>${
                isNumber(r.flip) ? `FLIP ${number(r.flip, 3)}, ` : ""
            }${isNumber(r.samples) ? plural(r.samples, "sample") : "no whole sample"}</small>`,
    );
}
function equalError(section) {
    section.innerHTML = readings(
        "At equal error",
        "The time until that relMSE; never: bias alone exceeds it.",
        report.equal_error,
        (e) => `relMSE ${number(e.relmse, 2)} (${rms(e.relmse)} rms)`,
        (r) =>
            isNumber(r.seconds)
                ? `${seconds(r.seconds)}${
                      r.seconds_se > 0 ? ` ± ${seconds(r.seconds_se)}` : ""
                  }<small>${isNumber(r.samples) ? plural(r.samples, "sample") : ""}</small>`
                : `<span class="soft">never</span>`,
    );
}
