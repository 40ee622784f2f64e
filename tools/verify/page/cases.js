// SPDX-License-Identifier: Apache-2.0
// What the program was held against: verdicts, plots, and every case.

const report = dataOf("report");
const cases = report.cases.map((c, index) => ({
    ...c,
    index,
    name: c.case,
    verdict: c.verdict.toLowerCase(),
    note: c.note || "",
    // What is not finite came as null.
    measured: c.measured ?? NaN,
    standardError: c.standard_error ?? Infinity,
    z: c.z ?? Infinity,
}));
const kinds = ["closed form", "slab", "surface", "property", "sampling", "extreme"];
const verdicts = ["fail", "imprecise", "pass"];
const largestZ = report.largest_z;

const figure = (v) => (Number.isNaN(v) ? "not finite" : number(v, 6));
const duration = (s) =>
    s < 90 ? `${s.toPrecision(3)} s` : `${Math.floor(s / 60)} min ${Math.round(s % 60)} s`;
const sum = (list) => list.reduce((a, b) => a + b, 0);
const random = (c) =>
    c.standardError > 0 && Number.isFinite(c.standardError) && Number.isFinite(c.measured);
const difference = (c) => c.measured - c.expected;

// ---- summary

function headline() {
    const bad = cases.filter((c) => c.verdict !== "pass").length;
    const failed = cases.filter((c) => c.verdict === "fail").length;
    if (!cases.length) return `<h1 class="imprecise">No case was run</h1>`;
    if (!bad)
        return `<h1 class="pass">${
            cases.length === 1 ? "The one case passes" : `All ${cases.length} cases pass`
        }</h1>`;
    const parts = [
        failed && `${failed} fail`,
        bad - failed && `${bad - failed} too imprecise to tell`,
    ];
    return `<h1 class="${failed ? "fail" : "imprecise"}">Of ${plural(cases.length, "case")},
        ${parts.filter(Boolean).join(", ")}</h1>`;
}

function falseAlarms() {
    const n = cases.filter(random).length;
    const some = 1 - Math.pow(1 - 6.334e-5, n); // beyond four standard errors, both sides
    const rate =
        some > 0
            ? `about one run in ${number(Math.max(1, Math.round(1 / some)), 2)} has one by chance
                alone`
            : "none can come by chance alone";
    return `${plural(n, "case")} with random numbers: |z| &gt; ${largestZ} fails, and ${rate}`;
}

function summary() {
    const b = report.build;
    const facts = {
        Version: `woodcock ${escape(report.version)}`,
        Build: escape(`${b.compiler}${b.assertions ? ", assertions on" : ""}`),
        Threads: report.threads,
        Date: escape(report.date.replace("T", " ").replace("Z", " UTC")),
        Effort: `${
            report.full ? "full: three digits and more" : "quick: two digits"
        }; took ${duration(report.seconds)}`,
        Seed: report.seed,
        Volumes: report.volumes.map(escape).join("<br>") || "none of your own",
        "False alarms": falseAlarms(),
    };
    if (report.only) facts["Only checks of"] = escape(report.only);
    const cards = kinds.map((kind) => {
        const own = cases.filter((c) => c.kind === kind),
            passed = own.filter((c) => c.verdict === "pass").length;
        const seconds = sum(report.checks.filter((c) => c.kind === kind).map((c) => c.seconds));
        const state = !own.length
            ? "soft"
            : passed === own.length
              ? "pass"
              : own.some((c) => c.verdict === "fail")
                ? "fail"
                : "imprecise";
        return (
            `<div class="card">${kind}<b class="${state}">${
                own.length ? `${passed} of ${own.length}` : "none run"
            }</b>` +
            `<span class="soft">${own.length ? `pass, ${duration(seconds)}` : ""}</span></div>`
        );
    });
    return (
        headline() +
        (report.complete
            ? ""
            : `<p class="imprecise">Interrupted: these are the cases until then.</p>`) +
        `<p class="soft">The renderer held against what theory knows, on this machine and
            build.</p>` +
        `<dl class="facts">${Object.entries(facts)
            .map(([k, v]) => `<dt>${k}</dt><dd>${v}</dd>`)
            .join("")}</dl>` +
        `<div class="cards">${cards.join("")}</div>`
    );
}

// ---- tables

const columns = [
    { name: "Case", text: (c) => c.name, key: (c) => c.name, cell: "name" },
    { name: "Kind", text: (c) => c.kind, key: (c) => kinds.indexOf(c.kind), cell: "kind" },
    { name: "Expected", text: (c) => figure(c.expected), key: (c) => c.expected, cell: "number" },
    { name: "Measured", text: (c) => figure(c.measured), key: (c) => c.measured, cell: "number" },
    {
        name: "Standard error",
        text: (c) => (c.standardError ? number(c.standardError, 2) : "0"),
        key: (c) => c.standardError,
        cell: "number",
    },
    { name: "z", text: (c) => number(c.z, 3), key: (c) => Math.abs(c.z), cell: "number" },
    {
        name: "Verdict",
        text: (c) => c.verdict,
        key: (c) => verdicts.indexOf(c.verdict),
        cell: "verdict",
        mood: (c) => c.verdict,
    },
    { name: "Note", text: (c) => c.note, key: (c) => c.note, cell: "note" },
];

const failingFirst = (a, b) =>
    verdicts.indexOf(a.verdict) - verdicts.indexOf(b.verdict) || a.index - b.index;

function caseTable(section) {
    const options = (list) =>
        `<option value="">all</option>` + list.map((v) => `<option>${v}</option>`).join("");
    const kindsThere = kinds.filter((k) => cases.some((c) => c.kind === k));
    const verdictsThere = verdicts.filter((v) => cases.some((c) => c.verdict === v));
    section.innerHTML = `<h2>Cases</h2><form role="search">
        <label>Name or note contains <input type="search" id="text"></label>
        <label>Kind <select id="kind">${options(kindsThere)}</select></label>
        <label>Verdict <select id="verdict">${options(verdictsThere)}</select></label>
        </form><p class="soft" role="status"></p><div></div>`;
    const value = (id) => section.querySelector("#" + id).value;
    const filtered = () => {
        const text = value("text").toLowerCase();
        const list = cases.filter(
            (c) =>
                (!value("kind") || c.kind === value("kind")) &&
                (!value("verdict") || c.verdict === value("verdict")) &&
                (c.name + " " + c.note).toLowerCase().includes(text),
        );
        section.querySelector("p").textContent =
            `${list.length} of ${plural(cases.length, "case")}`;
        return list;
    };
    const draw = sortableTable(
        section.lastElementChild,
        filtered,
        columns,
        { column: columns[6], down: false },
        failingFirst,
    );
    section.querySelector("form").addEventListener("input", draw);
    section.querySelector("form").addEventListener("submit", (event) => event.preventDefault());
}
