// SPDX-License-Identifier: Apache-2.0
// Numbers in words: times, shares, bytes and what is measured.

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
