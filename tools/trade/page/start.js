// SPDX-License-Identifier: Apache-2.0
// Puts the page together.

document.title = `woodcock trade: ${report.scene}`;
main.innerHTML = "";
let errorChart = null,
    errorSection = null;
section((s) => {
    s.innerHTML = head();
});
section((s) =>
    choose(s, (moved) => {
        if (moved && errorSection) errorChart = errorPlot(errorSection);
        else errorChart?.redraw();
    }),
);
section((s) => {
    errorSection = s;
    errorChart = errorPlot(s);
});
section((s) => {
    s.innerHTML = pointsTable();
});
section(biasPlots);
section(candidateTable);
section(equalTime);
section(equalError);
section(crops);
section((s) => {
    s.innerHTML = `<h2>What the words mean</h2><p class="soft">relMSE: the mean over pixels of
        (difference)² / (reference² + ε²), where ε is a hundredth of the reference's mean; its root,
        “rms”, is an error relative to the pixel. Biased: its error does not go to zero however long
        it renders. ± is one standard error. FLIP: the difference that is seen, from 0 to 1.</p>`;
});
keepPlots();
document.documentElement.dataset.ready = true;
