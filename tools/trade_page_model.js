// SPDX-License-Identifier: Apache-2.0
// What the report says, and what follows from it: error = variance / samples + (rms bias)^2, for any time and any error.

const report = dataOf("report");
const candidates = report.candidates.map((c, index) => ({...c, index, key: String(index + 1), hollow: c.biased, dashed: c.biased}));
const isNumber = v => typeof v === "number" && Number.isFinite(v);
const valueOf = measured => isNumber(measured?.value) ? measured.value : NaN;
const errorOf = measured => isNumber(measured?.se) ? measured.se : 0;

const seconds = v => !isNumber(v) ? "–" : v < 0.1 ? `${number(1000 * v, 2)} ms` : v < 300 ? `${number(v, v < 10 ? 2 : 3)} s` : v < 7200 ? `${Math.floor(Math.round(v) / 60)} min ${Math.round(v) % 60} s`
    : `${Math.floor(v / 3600)} h ${Math.round(v % 3600 / 60)} min`;
const percent = (v, digits = 2) => isNumber(v) ? `${number(100 * v, digits)} %` : "–";
const rms = relmse => isNumber(relmse) && relmse >= 0 ? percent(Math.sqrt(relmse)) : "–";
const bytes = v => !isNumber(v) ? "–" : v < 1 << 20 ? `${number(v / 1024, 3)} KiB` : v < 2 ** 30 ? `${number(v / 2 ** 20, 3)} MiB` : `${number(v / 2 ** 30, 3)} GiB`;

/** v ± se, with as many digits as the error leaves. */
function withError(v, se, scale = 1, unit = "") {
    if (!isNumber(v)) return "–";
    const digits = isNumber(se) && se > 0 && v !== 0 ? Math.max(2, Math.min(6, Math.floor(Math.log10(Math.abs(v))) - Math.floor(Math.log10(se)) + 2)) : 4;
    return number(scale * v, digits) + (isNumber(se) && se > 0 ? ` ± ${number(scale * se, 2)}` : "") + unit;
}

const settings = {kind: "time", time: 1, error: 1, unbiasedOnly: false, loading: false};
const loadingOf = c => settings.loading && isNumber(c.load_seconds) ? c.load_seconds : 0;
const allowed = () => candidates.filter(c => !settings.unbiasedOnly || !c.biased);

/** The squared bias and its standard error; without bias by construction, nothing that was measured is one. */
function squaredBias(c) {
    if (!c.biased) return [0, 0];
    const b = Math.max(0, valueOf(c.rms_bias) || 0), se = errorOf(c.rms_bias);
    return [b * b, b > 0 ? 2 * b * se : se * se];
}

/** What a candidate reaches in a time: {samples, relmse, se}; null when that is too short for one sample. */
function inTime(c, time) {
    const each = valueOf(c.seconds_per_sample), v = valueOf(c.variance), n = (time - loadingOf(c)) / each;
    if (!(n >= 1 - 1e-9) || !isNumber(v)) return null;
    const [b2, b2Error] = squaredBias(c), noise = v / n;
    const relative = Math.hypot(errorOf(c.variance) / v, errorOf(c.seconds_per_sample) / each);
    return {samples: Math.max(1, Math.floor(n + 1e-9)), relmse: noise + b2, se: Math.hypot(noise * relative, b2Error)};
}

/** What a candidate needs for an error: {samples, seconds, se}; null when its bias alone exceeds that. */
function forError(c, relmse) {
    const each = valueOf(c.seconds_per_sample), v = valueOf(c.variance), [b2, b2Error] = squaredBias(c);
    if (!(relmse > b2) || !isNumber(v) || !isNumber(each)) return null;
    const samples = Math.max(1, Math.ceil(v / (relmse - b2) - 1e-9)), time = samples * each;
    return {samples, seconds: loadingOf(c) + time,
        se: time * Math.hypot(errorOf(c.variance) / v, errorOf(c.seconds_per_sample) / each, b2Error / (relmse - b2))};
}

/** All that can, best first: [{c, samples, relmse or seconds, se, tied}]; tied: less than two standard errors behind the first. */
function ranking(kind, target, list = allowed()) {
    const key = kind === "time" ? "relmse" : "seconds", find = kind === "time" ? inTime : forError;
    const ranked = list.map(c => ({c, ...find(c, target)})).filter(r => isNumber(r[key])).sort((a, b) => a[key] - b[key]);
    return ranked.map((r, i) => ({...r, tied: i > 0 && r[key] - ranked[0][key] < 2 * Math.hypot(r.se, ranked[0].se)}));
}

/** The times and errors that can be asked for. */
const domain = (() => {
    const positive = list => list.filter(v => isNumber(v) && v > 0);
    const targets = kind => (report.recommendations || []).filter(r => r.kind === kind).map(r => r.target);
    const times = positive([...candidates.map(c => valueOf(c.seconds_per_sample)), report.budget, ...targets("time"),
        ...(report.equal_time || []).map(e => e.seconds), ...candidates.flatMap(c => (c.points || []).map(p => p.seconds))]);
    const time = times.length ? [Math.min(...times), Math.max(...times)] : [1, 10];
    const errors = positive([...time.map(t => ranking("time", t)[0]?.relmse), ...targets("error"), ...(report.equal_error || []).map(e => e.relmse)]);
    return {time, error: errors.length ? [Math.min(...errors), Math.max(...errors)] : [1e-4, 1]};
})();
const [firstTime] = [...(report.recommendations || []).filter(r => r.kind === "time").map(r => r.target), ...(report.equal_time || []).map(e => e.seconds)];
settings.time = firstTime ?? Math.sqrt(domain.time[0] * domain.time[1]);
settings.error = (report.recommendations || []).find(r => r.kind === "error")?.target ?? Math.sqrt(domain.error[0] * domain.error[1]);

/** Who is best from where to where: [{from, to, c}], c null where nobody can. */
function segments(kind) {
    const [low, high] = domain[kind].map(Math.log), steps = 600, list = [];
    for (let i = 0; i <= steps; ++i) {
        const at = Math.exp(low + (high - low) * i / steps), c = ranking(kind, at)[0]?.c || null, last = list[list.length - 1];
        if (last && last.c === c) last.to = at;
        else list.push({from: last ? last.to : at, to: at, c});
    }
    return list;
}

/** The command line for a target, as the report has it where it has. */
function commandFor(kind, target, r) {
    const own = (report.recommendations || []).find(x => x.kind === kind && x.candidate === r.c.index && Math.abs(x.target - target) <= 1e-6 * target);
    if (own) return own.command;
    // The scene's own number of samples must not end it sooner.
    return `${r.c.command} ` + (kind === "time" ? `--spp 1000000 --time-limit ${Number(target.toPrecision(3))}s` : `--spp ${r.samples}`);
}
