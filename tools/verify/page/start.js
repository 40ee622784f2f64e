// SPDX-License-Identifier: Apache-2.0
// Puts the page together.

main.innerHTML = "";
section((s) => (s.innerHTML = summary()));
const failing = cases.filter((c) => c.verdict !== "pass");
if (failing.length)
    section(
        (s) =>
            (s.innerHTML =
                `<h2>What does not pass</h2>` + table([...failing].sort(failingFirst), columns)),
    );
section(errorPlots);
section(histogram);
section(curvePlots);
const extremes = cases.filter((c) => c.kind === "extreme");
if (extremes.length)
    section(
        (s) =>
            (s.innerHTML =
                `<h2>Extremes</h2>` +
                table(
                    [...extremes].sort(failingFirst),
                    columns.filter((c) => c.name !== "Kind"),
                )),
    );
section(caseTable);
keepPlots();
document.documentElement.dataset.ready = true;
