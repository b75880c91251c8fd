// What a student and a page do with labs for minutes: runs in a page. Nothing is freed by hand.

/** Minutes of simulated time at 60 frames a second; `measure` is called after each part, of `part` minutes. */
export async function useLabs(labspec, labs, minutes, part, measure) {
  const { Data, Expression, Lab } = labspec;
  const sizes = [];
  let open = labs.map(({ json, models }) => new Lab(json, models));
  for (let minute = 0; minute < minutes; minute++) {
    const at = minute % labs.length;
    const lab = open[at];
    const off = [lab.on("contact", () => 0), lab.on("finding", () => 0), lab.on("warning", () => 0)];
    for (let frame = 0; frame < 3600; frame++) {
      lab.playTo(lab.time + 1 / 60);
      void [lab.numbers, lab.poses];
      if (frame % 6 === 0) void [lab.contacts, lab.findings, lab.data.qpos, lab.shown];
      if (frame % 300 === 0) move(lab, frame);
      if (frame % 600 === 0) {
        lab.restore(lab.save());
        void lab.save().toBytes();
      }
      // A page has its turn after each frame; here after some.
      if (frame % 60 === 0) await new Promise((resolve) => setTimeout(resolve, 0));
    }
    off.forEach((end) => end());
    const model = lab.toModel();
    const data = new Data(model);
    void [new Expression(model, "data.qpos[0]").record(data, 10), data.xpos, data.save()];
    try { lab.set("no such control", 1); } catch { /* as a page does */ }
    // A student turns the page: the labs are opened anew, and the old ones left to the garbage collector.
    if (at === labs.length - 1) open = labs.map(({ json, models }) => new Lab(json, models));
    if ((minute + 1) % part === 0) sizes.push(await measure());
  }
  return sizes;
}

/** Moves every control to one of its values. */
function move(lab, seed) {
  lab.controls.forEach((control, i) => {
    if (control.kind === "button") return lab.press(control.label);
    if (control.kind === "select") return lab.set(control.label, control.options[(seed / 300 + i) % control.options.length][0]);
    const { min, max, step } = control;
    lab.set(control.label, min + step * ((seed * 7919 + i * 104729) % (Math.floor((max - min) / step + 1e-9) + 1)));
  });
  if (lab.isOver || seed % 1800 === 0) lab.reset();
}
