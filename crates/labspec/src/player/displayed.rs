//! The displayed values of a page: the traces of plots and the readouts, with their labels and units.

use crate::spec::Lab;

/// A trace or a readout.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplayedValue {
    /// Its label.
    pub label: String,
    /// Its unit, from the parentheses at the end of its label or of the axis label: `height (m)`. Possibly empty.
    pub unit: String,
    /// Where it is displayed.
    pub place: DisplayedIn,
}

/// Where a value is displayed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayedIn {
    /// A curve of this plot, from 0.
    Plot(usize),
    /// A readout with this number of decimals: see [`Cell::rounded`](crate::run::Cell::rounded).
    Readout(u32),
}

/// Traces in the order of plots, then readouts: the order of values.
pub(super) fn list(lab: &Lab) -> Vec<DisplayedValue> {
    let mut all = Vec::new();
    for (i, plot) in lab.plots.iter().enumerate() {
        let axis = plot.ylabel.as_ref().map_or("", |t| t.as_str());
        for trace in &plot.traces {
            let label = trace.label.value.clone();
            let unit = [unit(&label), unit(axis)].into_iter().find(|u| !u.is_empty()).unwrap_or("");
            all.push(DisplayedValue { unit: unit.to_string(), label, place: DisplayedIn::Plot(i) });
        }
    }
    for readout in &lab.readouts {
        let label = readout.label.value.clone();
        all.push(DisplayedValue {
            unit: unit(&label).to_string(),
            label,
            place: DisplayedIn::Readout(readout.digits()),
        });
    }
    all
}

/// The text in parentheses at the end of a label.
fn unit(label: &str) -> &str {
    let inside = label.trim_end().strip_suffix(')').and_then(|rest| rest.rsplit_once('('));
    inside.map_or("", |(_, unit)| unit.trim())
}

#[cfg(test)]
mod tests {
    use super::unit;

    #[test]
    fn a_unit_is_read_from_parentheses_at_the_end() {
        for (label, expected) in [
            ("height (m)", "m"),
            ("speed (m/s) ", "m/s"),
            ("x (old) y", ""),
            ("(", ""),
            (")", ""),
            ("()", ""),
            ("", ""),
        ] {
            assert_eq!(unit(label), expected, "{label}");
        }
    }
}
