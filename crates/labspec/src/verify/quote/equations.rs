//! The TeX of displayed equations: environments that align several lines, and units that are written as a fraction.

use crate::markdown::tex;
use labspec_bind::units;

/// Environments that align equations. The cells of others, such as matrices, are separate texts.
const ALIGNED: [&str; 17] = [
    "aligned",
    "align",
    "align*",
    "alignedat",
    "alignat",
    "alignat*",
    "split",
    "gathered",
    "gather",
    "gather*",
    "equation",
    "equation*",
    "eqnarray",
    "eqnarray*",
    "multline",
    "multline*",
    "multlined",
];

/// Commands for fractions.
const FRACTIONS: [&str; 5] = ["frac", "tfrac", "dfrac", "sfrac", "nicefrac"];

/// Maximum length of the name of an environment, and of a distance between lines, in bytes.
const MAX_NAME: usize = 12;

/// Maximum length of an argument, in bytes.
const MAX_ARGUMENT: usize = 60;

/// The text after a command for the layout of equations at the beginning of `text`. `aligned` is the number of open environments.
pub(super) fn layout<'t>(text: &'t str, aligned: &mut usize) -> Option<&'t str> {
    if let Some((rest, begins)) = environment(text) {
        *aligned = if begins { *aligned + 1 } else { aligned.saturating_sub(1) };
        return Some(rest);
    }
    line_end(text).filter(|_| *aligned > 0)
}

/// The text after `\begin{aligned}` or `\end{aligned}` at the beginning of `text`, and whether the environment begins.
fn environment(text: &str) -> Option<(&str, bool)> {
    let (rest, command) = tex::command(text).ok().filter(|(_, name)| matches!(*name, "begin" | "end"))?;
    let begins = command == "begin";
    let (rest, name) = tex::group(rest, MAX_NAME).ok().filter(|(_, name)| ALIGNED.contains(name))?;
    // The number of columns, and the vertical position.
    let position = ["[t]", "[b]", "[c]"].into_iter().find_map(|p| rest.strip_prefix(p)).filter(|_| begins);
    let rest = position.unwrap_or(rest);
    let columns = tex::group(rest, MAX_NAME).ok();
    let columns = columns.filter(|(_, count)| begins && name.contains("at") && count.parse::<u8>().is_ok());
    Some((columns.map_or(rest, |(rest, _)| rest), begins))
}

/// The text after the end of a line with the distance to the next one: `\\\\[4pt]`.
fn line_end(text: &str) -> Option<&str> {
    let (distance, rest) = text.strip_prefix("\\\\[")?.split_at_checked(MAX_NAME.min(text.len() - 3))?;
    let close = distance.find(']')?;
    text.get(text.len() - rest.len() - distance.len() + close + 1..)
}

/// The text after `\frac{\mathrm{m}}{\mathrm{s}}` at the beginning of `text`, and the unit that it states: `m/s`. `fold` normalizes
/// the text of an argument.
pub(super) fn fraction_of_units<'t>(
    text: &'t str,
    fold: &dyn Fn(&str) -> String,
) -> Option<(&'t str, String)> {
    let (rest, name) = tex::command(text).ok()?;
    if !FRACTIONS.contains(&name) {
        return None;
    }
    let (rest, above) = tex::group(rest.trim_start(), MAX_ARGUMENT).ok()?;
    let (rest, below) = tex::group(rest.trim_start(), MAX_ARGUMENT).ok()?;
    // A power would apply to the whole fraction.
    if rest.trim_start_matches(['}', ' ']).starts_with(['^', '\''])
        || [above, below].iter().any(|t| t.contains("frac"))
    {
        return None;
    }
    let plain = |tex: &str| fold(tex).trim().to_string();
    let whole =
        |unit: String| if unit.chars().all(char::is_alphanumeric) { unit } else { format!("({unit})") };
    let (above, below) = (plain(above), plain(below));
    let units = (above == "1" || units::is_unit(&above)) && units::is_unit(&below) && below != "1";
    let unit = format!("{}/{}", whole(above), whole(below));
    (units && units::is_unit(&unit)).then_some((rest, unit))
}
