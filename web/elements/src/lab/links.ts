/** Labs with the same `link`: a control that is moved in one of them moves in all that have a control with its label. */
import type { Control, ControlValue } from "labspec/slim";

/** A lab that is linked to others. */
export interface LinkMember {
  readonly controls: readonly Control[];
  set(label: string, value: ControlValue): void;
  press(label: string): void;
}

export interface Link {
  /** A control of this lab was moved. */
  moved(label: string, value: ControlValue): void;
  /** A button of this lab was pressed. */
  pressed(label: string): void;
  leave(): void;
}

interface Group {
  readonly members: Set<LinkMember>;
  /** The last value of each control that was moved, for labs that are opened later. */
  readonly values: Map<string, ControlValue>;
}

const groups = new Map<string, Group>();

/** Whether a lab has a control with this label that can take this value. */
function takes({ controls }: LinkMember, label: string, value: ControlValue): boolean {
  const control = controls.find((one) => one.label === label);
  if (control?.kind === "select") return control.options?.some(([, own]) => own === value) === true;
  return control?.kind === "slider" && typeof value === "number" && value >= (control.min ?? -Infinity) && value <= (control.max ?? Infinity);
}

/** Links a lab to those with the same name. It takes the values of controls that were moved before, unless `keepsOwn`. */
export function joinLink(name: string, member: LinkMember, keepsOwn: boolean): Link {
  const group = groups.get(name) ?? { members: new Set(), values: new Map() };
  groups.set(name, group);
  group.members.add(member);
  if (!keepsOwn) for (const [label, value] of group.values) if (takes(member, label, value)) member.set(label, value);
  const others = (): LinkMember[] => [...group.members].filter((one) => one !== member);
  return {
    moved(label, value) {
      group.values.set(label, value);
      for (const other of others()) if (takes(other, label, value)) other.set(label, value);
    },
    pressed(label) {
      for (const other of others()) if (other.controls.some((one) => one.kind === "button" && one.label === label)) other.press(label);
    },
    leave() {
      group.members.delete(member);
      if (group.members.size === 0) groups.delete(name);
    },
  };
}
