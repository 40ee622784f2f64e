// SPDX-License-Identifier: Apache-2.0
// What the report says, and what follows from it for any time and any error. The program fits the
// models: the error is a candidate's bias, and its noise divided by the time of rendering.

const report = dataOf("report");
const models = dataOf("models");
const candidates = report.candidates.map((c, index) => ({
    ...c,
    model: models.candidates[index],
    index,
    key: String(index + 1),
    hollow: c.biased,
    dashed: c.biased,
}));
const valueOf = (measured) => (isNumber(measured?.value) ? measured.value : NaN);
const errorOf = (measured) => (isNumber(measured?.se) ? measured.se : 0);
const orInfinite = (se) => se ?? Infinity; // which JSON cannot say

const settings = { kind: "time", time: 1, error: 1, unbiasedOnly: false, loading: false };
const loadingOf = (c) => (settings.loading && isNumber(c.load_seconds) ? c.load_seconds : 0);
const allowed = () => candidates.filter((c) => !settings.unbiasedOnly || !c.biased);

/**
 * What a candidate reaches in a time: {samples, relmse, se}; null when that is too short for one
 * sample.
 */
function inTime(c, time) {
    if (!c.model) return null;
    const { bias, noise, seconds_per_sample: each } = c.model;
    const rendering = time - loadingOf(c);
    if (!(rendering / each >= 1 - 1e-9)) return null;
    return {
        samples: Math.max(1, Math.floor(rendering / each + 1e-9)),
        relmse: bias.value + noise.value / rendering,
        se: Math.hypot(bias.se, orInfinite(noise.se) / rendering),
    };
}

/**
 * What a candidate needs for an error: {samples, seconds, se}; null when its bias alone exceeds
 * that.
 */
function forError(c, relmse) {
    if (!c.model || !(relmse > c.model.bias.value)) return null;
    const { bias, noise, seconds_per_sample: each } = c.model;
    const room = relmse - bias.value;
    const rendering = Math.max(each, noise.value / room);
    return {
        samples: Math.ceil(rendering / each - 1e-9),
        seconds: loadingOf(c) + rendering,
        se: Math.hypot(orInfinite(noise.se), (noise.value / room) * bias.se) / room,
    };
}

/**
 * The standard error of a difference of two of a ranking. In the same time of rendering, both met
 * the same random numbers, seed by seed.
 */
function errorOfDifference(a, b, kind, time) {
    if (kind === "error" || loadingOf(a.c) !== loadingOf(b.c)) return Math.hypot(a.se, b.se);
    const noise = orInfinite(a.c.model.noise_difference_se[b.c.index]);
    const rendering = time - loadingOf(a.c);
    return Math.hypot(a.c.model.bias.se, b.c.model.bias.se, noise / rendering);
}

/**
 * All that can, best first: [{c, samples, relmse or seconds, se, tied}]. Tied: the standard error
 * of the difference does not tell it from the first.
 */
function ranking(kind, target, list = allowed()) {
    const key = kind === "time" ? "relmse" : "seconds",
        find = kind === "time" ? inTime : forError;
    const ranked = list
        .map((c) => ({ c, ...find(c, target) }))
        .filter((r) => isNumber(r[key]))
        .sort((a, b) => a[key] - b[key]);
    const first = ranked[0];
    const isTied = (r) =>
        r[key] - first[key] <= models.tie_width * errorOfDifference(r, first, kind, target);
    return ranked.map((r) => ({ ...r, tied: r !== first && isTied(r) }));
}

/** Which to take of a ranking: the best, or the best without bias that is tied with it. */
const recommended = (list) =>
    (list[0]?.c.biased && list.find((r) => r.tied && !r.c.biased)) || list[0];

/** The times and errors that can be asked for. */
const domain = (() => {
    const positive = (list) => list.filter((v) => isNumber(v) && v > 0);
    const targets = (kind) =>
        (report.recommendations || []).filter((r) => r.kind === kind).map((r) => r.target);
    const times = positive([
        ...candidates.map((c) => valueOf(c.seconds_per_sample)),
        report.budget,
        ...targets("time"),
        ...(report.equal_time || []).map((e) => e.seconds),
        ...candidates.flatMap((c) => (c.points || []).map((p) => p.seconds)),
    ]);
    const time = times.length ? [Math.min(...times), Math.max(...times)] : [1, 10];
    const errors = positive([
        ...time.map((t) => ranking("time", t)[0]?.relmse),
        ...targets("error"),
        ...(report.equal_error || []).map((e) => e.relmse),
    ]);
    // Beyond 1, there is no picture.
    const sensible = errors.some((e) => e < 1) ? errors.map((e) => Math.min(e, 1)) : errors;
    return {
        time,
        error: errors.length ? [Math.min(...sensible), Math.max(...sensible)] : [1e-4, 1],
    };
})();
const [firstTime] = [
    ...(report.recommendations || []).filter((r) => r.kind === "time").map((r) => r.target),
    ...(report.equal_time || []).map((e) => e.seconds),
];
settings.time = firstTime ?? Math.sqrt(domain.time[0] * domain.time[1]);
settings.error =
    (report.recommendations || []).find((r) => r.kind === "error")?.target ??
    Math.sqrt(domain.error[0] * domain.error[1]);

/** Which to take from where to where: [{from, to, c}], c null where none can. */
function segments(kind) {
    const [low, high] = domain[kind].map(Math.log),
        steps = 600,
        list = [];
    for (let i = 0; i <= steps; ++i) {
        const at = Math.exp(low + ((high - low) * i) / steps),
            c = recommended(ranking(kind, at))?.c || null,
            last = list[list.length - 1];
        if (last && last.c === c) last.to = at;
        else list.push({ from: last ? last.to : at, to: at, c });
    }
    return list;
}

/** The command line for a target, as the report has it where it has. */
function commandFor(kind, target, r) {
    const own = (report.recommendations || []).find(
        (x) =>
            x.kind === kind &&
            x.candidate === r.c.index &&
            Math.abs(x.target - target) <= 1e-6 * target,
    );
    if (own) return own.command;
    // The scene's own number of samples must not end it sooner.
    return (
        `${r.c.command} ` +
        (kind === "time"
            ? `--spp 1000000 --time-limit ${Number(target.toPrecision(3))}s`
            : `--spp ${r.samples}`)
    );
}
