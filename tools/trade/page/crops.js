// SPDX-License-Identifier: Apache-2.0
// Crops side by side; one enlarged gives way to the reference while it is held.

const shownCrops = (report.crops || []).filter((crop) => /^data:image\//.test(crop.png || ""));

function crops(section) {
    section.hidden = !shownCrops.length;
    if (!shownCrops.length) return;
    const taken = new Set(candidates.map((c) => c.crop)),
        first = (report.crops || []).findIndex((crop, i) => !taken.has(i) && crop.png);
    const reference = report.crops[first] || shownCrops[0];
    section.innerHTML = `<h2>Crops at equal time</h2>
        <p class="soft">Press one to enlarge it; then hold it, or the space bar, to see the
        reference in its place. The arrow keys go on to the next.</p>
        <div class="crops">${shownCrops
            .map(
                (crop, i) => `<figure><button type="button"
        data-crop="${i}" aria-label="Enlarge ${escape(crop.title)}"><img alt=""
        class="crop"></button><figcaption>${escape(crop.title)}</figcaption></figure>`,
            )
            .join("")}</div>
        <dialog aria-label="Crop, enlarged"><figure><img alt="" class="crop large"
        draggable="false"><figcaption></figcaption></figure>
        <form method="dialog"><button type="button" data-step="-1"
        aria-label="Previous">←</button><button type="button" class="flip">Hold:
        reference</button><button type="button" data-step="1"
        aria-label="Next">→</button><button>Close</button></form></dialog>`;
    section.querySelectorAll(".crops img").forEach((img, i) => {
        img.src = shownCrops[i].png;
    });
    const dialog = section.querySelector("dialog"),
        image = dialog.querySelector("img"),
        caption = dialog.querySelector("figcaption"),
        flip = dialog.querySelector(".flip");
    let at = 0;
    const show = (crop) => {
        ((image.src = crop.png), (image.alt = caption.textContent = crop.title));
    };
    const go = (i) => {
        at = (i + shownCrops.length) % shownCrops.length;
        show(shownCrops[at]);
    };
    const hold = () => show(reference),
        release = () => show(shownCrops[at]);
    section.addEventListener("click", (event) => {
        const opened = event.target.closest("[data-crop]"),
            step = event.target.dataset.step;
        if (opened) {
            go(Number(opened.dataset.crop));
            dialog.showModal();
            flip.focus();
        }
        if (step) go(at + Number(step));
        if (event.target === dialog) dialog.close();
    });
    for (const held of [image, flip]) {
        held.addEventListener("pointerdown", (event) => {
            held.setPointerCapture(event.pointerId);
            hold();
        });
        (held.addEventListener("pointerup", release),
            held.addEventListener("pointercancel", release));
        held.addEventListener("contextmenu", (event) => event.preventDefault());
    }
    dialog.addEventListener("keydown", (event) => {
        const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
        if (step) go(at + step);
        if (event.key === " " && (event.target === flip || !event.target.matches("button"))) {
            event.preventDefault();
            hold();
        }
    });
    dialog.addEventListener("keyup", (event) => {
        if (event.key === " ") release();
    });
}
