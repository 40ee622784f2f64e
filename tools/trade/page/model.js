// SPDX-License-Identifier: Apache-2.0
// What the report says, and what follows from it: error = variance / samples + (rms bias)^2, for any time and any error.

const report = dataOf("report");
const candidates = report.candidates.map((c, index) => ({
    ...c,
    index,
    key: String(index + 1),
    hollow: c.biased,
    dashed: c.biased,
}));
const isNumber = (v) => typeof v === "number" && Number.isFinite(v);
const valueOf = (measured) => (isNumber(measured?.value) ? measured.value : NaN);
const errorOf = (measured) => (isNumber(measured?.se) ? measured.se : 0);

const gap = "\u00a0"; // between a number and its unit, where no line may break
const seconds = (v) =>
    !isNumber(v)
        ? "–"
        : v < 0.1
          ? `${number(1000 * v, 2)}${gap}ms`
          : v < 300
            ? `${number(v, v < 10 ? 2 : 3)}${gap}s`
            : v < 7200
              ? `${Math.floor(Math.round(v) / 60)}${gap}min ${Math.round(v) % 60}${gap}s`
              : `${Math.floor(v / 3600)}${gap}h ${Math.round((v % 3600) / 60)}${gap}min`;
const percent = (v, digits = 2) => (isNumber(v) ? `${number(100 * v, digits)}${gap}%` : "–");
const rms = (relmse) => (isNumber(relmse) && relmse >= 0 ? percent(Math.sqrt(relmse)) : "–");
const bytes = (v) =>
    !isNumber(v)
        ? "–"
        : v < 1 << 20
          ? `${number(v / 1024, 3)} KiB`
          : v < 2 ** 30
            ? `${number(v / 2 ** 20, 3)} MiB`
            : `${number(v / 2 ** 30, 3)} GiB`;

/** v ± se, with as many digits as the error leaves. */
function withError(v, se, scale = 1, unit = "") {
    if (!isNumber(v)) return "–";
    const digits =
        isNumber(se) && se > 0 && v !== 0
            ? Math.max(
                  2,
                  Math.min(6, Math.floor(Math.log10(Math.abs(v))) - Math.floor(Math.log10(se)) + 2),
              )
            : 4;
    return (
        number(scale * v, digits) +
        (isNumber(se) && se > 0 ? ` ± ${number(scale * se, 2)}` : "") +
        unit
    );
}

const settings = { kind: "time", time: 1, error: 1, unbiasedOnly: false, loading: false };
const loadingOf = (c) => (settings.loading && isNumber(c.load_seconds) ? c.load_seconds : 0);
const allowed = () => candidates.filter((c) => !settings.unbiasedOnly || !c.biased);

/** The squared bias and its standard error; without bias by construction, nothing that was measured is one. */
function squaredBias(c) {
    if (!c.biased) return [0, 0];
    const b = Math.max(0, valueOf(c.rms_bias) || 0),
        se = errorOf(c.rms_bias);
    return [b * b, 2 * b * se + se * se];
}

const mean = (list) => list.reduce((a, b) => a + b, 0) / list.length;
const errorOfMean = (list) =>
    Math.sqrt(
        list.reduce((a, b) => a + Math.pow(b - mean(list), 2), 0) /
            (list.length * (list.length - 1)),
    );

/** Variance x seconds per sample: what noise is, times the time. Each seed has its own where the report says so. */
function noiseOf(c) {
    if (c.costs?.length > 1) return { value: mean(c.costs), se: errorOfMean(c.costs) };
    const each = valueOf(c.seconds_per_sample),
        v = valueOf(c.variance);
    return {
        value: v * each,
        se: v * each * Math.hypot(errorOf(c.variance) / v, errorOf(c.seconds_per_sample) / each),
    };
}

/** What a candidate reaches in a time: {samples, relmse, se}; null when that is too short for one sample. */
function inTime(c, time) {
    const rendering = time - loadingOf(c),
        n = rendering / valueOf(c.seconds_per_sample),
        noise = noiseOf(c);
    if (!(n >= 1 - 1e-9) || !isNumber(noise.value)) return null;
    const [b2, b2Error] = squaredBias(c);
    return {
        samples: Math.max(1, Math.floor(n + 1e-9)),
        relmse: noise.value / rendering + b2,
        se: Math.hypot(noise.se / rendering, b2Error),
    };
}

/** What a candidate needs for an error: {samples, seconds, se}; null when its bias alone exceeds that. */
function forError(c, relmse) {
    const each = valueOf(c.seconds_per_sample),
        noise = noiseOf(c),
        [b2, b2Error] = squaredBias(c),
        room = relmse - b2;
    if (!(room > 0) || !isNumber(noise.value)) return null;
    const time = Math.max(each, noise.value / room);
    return {
        samples: Math.ceil(time / each - 1e-9),
        seconds: loadingOf(c) + time,
        se: Math.hypot(noise.se, time * b2Error) / room,
    };
}

/** The standard error of a difference of two of a ranking: in time, both met the same random numbers, seed by seed. */
function errorOfDifference(a, b, kind, time) {
    const [p, q] = [a.c.costs || [], b.c.costs || []];
    if (
        kind === "error" ||
        p.length < 2 ||
        p.length !== q.length ||
        loadingOf(a.c) !== loadingOf(b.c)
    )
        return Math.hypot(a.se, b.se);
    return Math.hypot(
        squaredBias(a.c)[1],
        squaredBias(b.c)[1],
        errorOfMean(p.map((v, i) => v - q[i])) / (time - loadingOf(a.c)),
    );
}

/** All that can, best first: [{c, samples, relmse or seconds, se, tied}]; tied: not two standard errors of the difference behind the first. */
function ranking(kind, target, list = allowed()) {
    const key = kind === "time" ? "relmse" : "seconds",
        find = kind === "time" ? inTime : forError;
    const ranked = list
        .map((c) => ({ c, ...find(c, target) }))
        .filter((r) => isNumber(r[key]))
        .sort((a, b) => a[key] - b[key]);
    const first = ranked[0];
    return ranked.map((r) => ({
        ...r,
        tied: r !== first && r[key] - first[key] <= 2 * errorOfDifference(r, first, kind, target),
    }));
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
    const sensible = errors.some((e) => e < 1) ? errors.map((e) => Math.min(e, 1)) : errors; // beyond 1, there is no picture
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
