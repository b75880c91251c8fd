/** Sliders, selects and buttons of a lab, as native controls. */
import type { Control, ControlValue } from "labspec/slim";
export interface ControlPanel {
    readonly elements: readonly HTMLElement[];
    readonly buttons: readonly HTMLElement[];
    /** Shows where the controls of the lab stand, except the one that is being moved. */
    show(values: readonly (ControlValue | null)[]): void;
}
export interface ControlActions {
    set(label: string, value: ControlValue): void;
    press(label: string): void;
}
/** The controls of a lab, in their order. */
export declare function createControls(controls: readonly Control[], actions: ControlActions): ControlPanel;
/** A value with its unit. */
export declare function formatControl(control: Control, value: number): string;
