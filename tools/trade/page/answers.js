// SPDX-License-Identifier: Apache-2.0
// What the report says, and what is asked of it. The program answered every question that can be
// asked; here an answer is looked up.

const report = dataOf("report");
const answers = dataOf("answers");
const candidates = report.candidates.map((c, index) => ({
    ...c,
    index,
    key: String(index + 1),
    hollow: c.biased,
    dashed: c.biased,
}));
const valueOf = (measured) => (isNumber(measured?.value) ? measured.value : NaN);
const errorOf = (measured) => (isNumber(measured?.se) ? measured.se : 0);

/** The first and the last time, or error, that tells candidates apart. */
const domain = (kind) => answers[kind].sensible;

/** Which of the times or errors that were answered is nearest: the index of the target. */
function nearest(kind, value) {
    const { targets } = answers[kind],
        apart = (t) => Math.abs(Math.log(t / value));
    return targets.reduce((best, t, i) => (apart(t) < apart(targets[best]) ? i : best), 0);
}

const settings = { kind: "time", at: {}, unbiasedOnly: false, loading: false };
for (const kind of ["time", "error"]) {
    const own = (report.recommendations || []).find((r) => r.kind === kind)?.target;
    settings.at[kind] = nearest(kind, own ?? Math.sqrt(domain(kind)[0] * domain(kind)[1]));
}
const target = (kind = settings.kind) => answers[kind].targets[settings.at[kind]];
const loadingOf = (c) => (settings.loading && isNumber(c.load_seconds) ? c.load_seconds : 0);
const allowed = () => candidates.filter((c) => !settings.unbiasedOnly || !c.biased);
const weighed = (kind) => answers[kind][settings.loading ? "with_loading" : "rendering"];

/** The indices of the targets that tell candidates apart. */
function sensible(kind) {
    const [low, high] = domain(kind);
    return [...answers[kind].targets.keys()].filter(
        (at) => answers[kind].targets[at] >= low && answers[kind].targets[at] <= high,
    );
}

/**
 * Which to take at the target of this index: {best, tied, recommended, samples}, candidates by
 * index, samples of the recommended one; null where none can.
 */
function choice(kind, at, unbiasedOnly = settings.unbiasedOnly) {
    const { best, tied, recommended, samples } = weighed(kind)[unbiasedOnly ? "unbiased" : "all"];
    return best[at] === null
        ? null
        : {
              best: best[at],
              tied: tied[at],
              recommended: recommended[at],
              samples: samples[at],
          };
}

/**
 * What a candidate reaches there: {c, value, se}, the relMSE in a time or the seconds to an error;
 * the value is null where it cannot.
 */
const reached = (c, kind, at) => ({
    c,
    value: weighed(kind).value[c.index][at],
    se: weighed(kind).se[c.index][at],
});

/** All that can, best first. */
function ranking(kind, at) {
    const best = choice(kind, at)?.best;
    return allowed()
        .map((c) => reached(c, kind, at))
        .filter((r) => r.value !== null)
        .sort((a, b) => (b.c.index === best) - (a.c.index === best) || a.value - b.value);
}

/**
 * Which to take from where to where: [{from, to, c}], c null where none can. It changes midway
 * between two targets.
 */
function segments(kind) {
    const list = [];
    for (const i of sensible(kind)) {
        const at = answers[kind].targets[i],
            c = candidates[choice(kind, i)?.recommended] ?? null,
            last = list[list.length - 1];
        if (last && last.c !== c) last.to = Math.sqrt(last.to * at);
        if (last && last.c === c) last.to = at;
        else list.push({ from: last ? last.to : at, to: at, c });
    }
    return list;
}

/** The command line for the target that is asked for, as the report has it where it has. */
function commandFor(kind, c, samples) {
    const own = (report.recommendations || []).find(
        (x) =>
            x.kind === kind &&
            x.candidate === c.index &&
            Math.abs(x.target - target(kind)) <= 1e-6 * x.target,
    );
    if (own) return own.command;
    // The scene's own number of samples must not end it sooner.
    return (
        `${c.command} ` +
        (kind === "time" ? `--spp 1000000 --time-limit ${target(kind)}s` : `--spp ${samples}`)
    );
}
