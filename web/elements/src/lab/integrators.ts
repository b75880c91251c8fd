/**
 * A lab that compares integrators, as one lab for each of them: with a select that sets the integrator after `setup`, and a first plot of
 * the drift of the energy. `crates/labspec/src/spec/integrators.rs` adds the same control and the same plot; a test compares both.
 */
import { listOf, numberOf, readLab, type Json, type LabSpec, type PlotSpec, type TraceSpec } from "../spec.js";

/** The integrators that can be compared, in the order of their numbers in MuJoCo. */
export const INTEGRATORS: readonly string[] = ["Euler", "RK4", "implicit", "implicitfast"];
/** The label of the select. */
export const INTEGRATOR = "integrator";
/** The label of the trace, and of the vertical axis of its plot. */
export const ENERGY_DRIFT = "energy drift";

/** After a step, fields belong to the state before it, or to a stage of RK4: `mj_forward` computes the energy of the state that is shown. */
const DRIFT = "(() => { mj.mj_forward(model, data); return (lib.energy().total - ctx.energyStart) / ctx.energyUnit; })()";
/** Stores the energy at the start, and the unit of the drift: the energy itself, or 1 J where it is zero. */
const BASELINE = "mj.mj_forward(model, data); ctx.energyStart = lib.energy().total; ctx.energyUnit = Math.abs(ctx.energyStart) > 1e-9 ? Math.abs(ctx.energyStart) : 1";

/** The integrators of a lab: those of its list that exist, each once, or all. Empty for a lab that compares nothing. */
export function comparedIntegrators(lab: Json): readonly string[] {
  if (!Array.isArray(lab["integrators"])) return [];
  const listed = listOf(lab["integrators"]).filter((name): name is string => INTEGRATORS.includes(name as string));
  return listed.length > 0 ? [...new Set(listed)] : INTEGRATORS;
}

/** The lab of one integrator. */
export function labOfIntegrator(lab: Json, names: readonly string[], name: string): Json {
  const entries = Object.entries(lab).filter(([key]) => key !== "integrators" && key !== "timestep");
  const controls = [...listOf(lab["controls"]), integratorSelect(names, name, numberOf(lab["timestep"]))];
  return { ...Object.fromEntries(entries), controls, plots: plotsOf(lab) };
}

function plotsOf(lab: Json): readonly unknown[] {
  const window = numberOf(lab["stopAt"]);
  const energy = { ylabel: ENERGY_DRIFT, ...(window === null ? {} : { window }), traces: [{ label: ENERGY_DRIFT, expr: DRIFT }] };
  return [energy, ...listOf(lab["plots"])];
}

function integratorSelect(names: readonly string[], name: string, timestep: number | null): Json {
  return {
    type: "select", label: INTEGRATOR, options: names.map((one) => [one, one]), value: name,
    apply: statements(timestep), init: true, reset: true,
  };
}

/** The statements of the select: they read the name of an integrator as `value`. */
function statements(timestep: number | null): string {
  const step = timestep !== null && timestep > 0 ? `model.opt.timestep = ${timestep.toExponential().replace("e+", "e")}; ` : "";
  const last = INTEGRATORS.length - 1;
  const cases = INTEGRATORS.slice(0, last).map((name, id) => `value === '${name}' ? ${id} : `).join("");
  return `${step}model.opt.integrator = ${cases}${last}; ${BASELINE}`;
}

/** Reads how a lab is shown, and the labs of the integrators that it compares. */
export function readSpec(lab: Json, json: string): LabSpec {
  const names = comparedIntegrators(lab);
  if (names.length === 0) return readLab(lab, json);
  const spec = readLab({ ...lab, plots: plotsOf(lab) }, json);
  const compared = names.map((name) => ({ name, json: JSON.stringify(labOfIntegrator(lab, names, name)) }));
  return { ...spec, plots: spec.plots.map((plot) => joinPlot(plot, names)), compared };
}

/** A plot with a curve of each trace for each integrator. */
function joinPlot(plot: PlotSpec, names: readonly string[]): PlotSpec {
  const label = (trace: TraceSpec, name: string): string => (plot.traces.length === 1 ? name : `${trace.label}, ${name}`);
  return { ...plot, traces: plot.traces.flatMap((trace) => names.map((name) => ({ ...trace, label: label(trace, name) }))) };
}
