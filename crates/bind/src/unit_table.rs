//! The names of units: symbols with their prefixes, and words in several languages.

use labspec_expr::dimension::{ANGLE, Dimension};
use std::f64::consts::PI;

pub(crate) const KG: usize = 1;
pub(crate) const M: usize = 2;
pub(crate) const S: usize = 3;
pub(crate) const K: usize = 4;
pub(crate) const A: usize = 5;

/// The prefixes of unit symbols, as powers of ten.
pub const PREFIXES: [(&str, i32); 13] = [
    ("", 0),
    ("p", -12),
    ("n", -9),
    ("μ", -6),
    ("u", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// A unit: its symbol, its size, the powers of its base units, and whether it can have a prefix.
struct UnitRow(&'static str, f64, &'static [(usize, i32)], bool);

const ANGLES: &[(usize, i32)] = &[(ANGLE, 1)];
const LENGTH: &[(usize, i32)] = &[(M, 1)];
const TIME: &[(usize, i32)] = &[(S, 1)];
const MASS: &[(usize, i32)] = &[(KG, 1)];
const FORCE: &[(usize, i32)] = &[(KG, 1), (M, 1), (S, -2)];
const ENERGY: &[(usize, i32)] = &[(KG, 1), (M, 2), (S, -2)];
const POWER: &[(usize, i32)] = &[(KG, 1), (M, 2), (S, -3)];
const PRESSURE: &[(usize, i32)] = &[(KG, 1), (M, -1), (S, -2)];

/// The symbols of units, case-sensitive, and names in scripts without capital letters.
const UNITS: [UnitRow; 53] = [
    UnitRow("rad", 1.0, ANGLES, true),
    UnitRow("deg", PI / 180.0, ANGLES, false),
    // Degrees in German, not 10⁹ radians.
    UnitRow("Grad", PI / 180.0, ANGLES, false),
    UnitRow("°", PI / 180.0, ANGLES, false),
    UnitRow("rev", 2.0 * PI, ANGLES, false),
    UnitRow("m", 1.0, LENGTH, true),
    UnitRow("ft", 0.3048, LENGTH, false),
    UnitRow("s", 1.0, TIME, true),
    UnitRow("min", 60.0, TIME, false),
    UnitRow("h", 3600.0, TIME, false),
    UnitRow("Std", 3600.0, TIME, false),
    UnitRow("g", 1e-3, MASS, true),
    UnitRow("lb", 0.453_592_37, MASS, false),
    UnitRow("lbs", 0.453_592_37, MASS, false),
    UnitRow("K", 1.0, &[(K, 1)], true),
    UnitRow("A", 1.0, &[(A, 1)], true),
    UnitRow("C", 1.0, &[(A, 1), (S, 1)], true),
    UnitRow("N", 1.0, FORCE, true),
    UnitRow("Nm", 1.0, ENERGY, true),
    UnitRow("Ns", 1.0, &[(KG, 1), (M, 1), (S, -1)], true),
    UnitRow("J", 1.0, ENERGY, true),
    UnitRow("W", 1.0, POWER, true),
    UnitRow("Pa", 1.0, PRESSURE, true),
    UnitRow("bar", 1e5, PRESSURE, true),
    UnitRow("Hz", 1.0, &[(S, -1)], true),
    UnitRow("rpm", 2.0 * PI / 60.0, &[(ANGLE, 1), (S, -1)], false),
    UnitRow("rps", 2.0 * PI, &[(ANGLE, 1), (S, -1)], false),
    UnitRow("bpm", 1.0 / 60.0, &[(S, -1)], false),
    UnitRow("mph", 0.447_04, &[(M, 1), (S, -1)], false),
    UnitRow("kph", 1.0 / 3.6, &[(M, 1), (S, -1)], false),
    UnitRow("V", 1.0, &[(KG, 1), (M, 2), (S, -3), (A, -1)], true),
    UnitRow("T", 1.0, &[(KG, 1), (S, -2), (A, -1)], true),
    UnitRow("L", 1e-3, &[(M, 3)], true),
    UnitRow("l", 1e-3, &[(M, 3)], true),
    UnitRow("秒", 1.0, TIME, true),
    UnitRow("秒钟", 1.0, TIME, false),
    UnitRow("秒鐘", 1.0, TIME, false),
    UnitRow("分", 60.0, TIME, false),
    UnitRow("分钟", 60.0, TIME, false),
    UnitRow("分鐘", 60.0, TIME, false),
    UnitRow("小时", 3600.0, TIME, false),
    UnitRow("小時", 3600.0, TIME, false),
    UnitRow("時間", 3600.0, TIME, false),
    UnitRow("米", 1.0, LENGTH, true),
    UnitRow("公里", 1e3, LENGTH, false),
    UnitRow("公分", 1e-2, LENGTH, false),
    UnitRow("メートル", 1.0, LENGTH, true),
    UnitRow("克", 1e-3, MASS, true),
    UnitRow("公斤", 1.0, MASS, false),
    UnitRow("グラム", 1e-3, MASS, true),
    UnitRow("度", PI / 180.0, ANGLES, false),
    UnitRow("弧度", 1.0, ANGLES, false),
    UnitRow("ラジアン", 1.0, ANGLES, true),
];

/// Further names in such scripts.
const NAMED: [UnitRow; 8] = [
    UnitRow("牛", 1.0, FORCE, true),
    UnitRow("牛顿", 1.0, FORCE, true),
    UnitRow("牛頓", 1.0, FORCE, true),
    UnitRow("ニュートン", 1.0, FORCE, true),
    UnitRow("焦耳", 1.0, ENERGY, true),
    UnitRow("ジュール", 1.0, ENERGY, true),
    UnitRow("瓦", 1.0, POWER, true),
    UnitRow("赫兹", 1.0, &[(S, -1)], true),
];

/// Names of units in lower case without a plural `s`: their size in the unit of a symbol, and that symbol.
const WORDS: [(&str, f64, &str); 108] = [
    ("radian", 1.0, "rad"),
    ("degree", 1.0, "°"),
    ("grad", 1.0, "°"),
    ("grado", 1.0, "°"),
    ("degré", 1.0, "°"),
    ("turn", 1.0, "rev"),
    ("revolution", 1.0, "rev"),
    ("metre", 1.0, "m"),
    ("meter", 1.0, "m"),
    ("mètre", 1.0, "m"),
    ("metro", 1.0, "m"),
    ("micron", 1e-6, "m"),
    ("inch", 0.0254, "m"),
    ("inche", 0.0254, "m"),
    ("foot", 0.3048, "m"),
    ("feet", 0.3048, "m"),
    ("yard", 0.9144, "m"),
    ("mile", 1609.344, "m"),
    ("furlong", 201.168, "m"),
    ("fathom", 1.8288, "m"),
    ("angstrom", 1e-10, "m"),
    ("ångström", 1e-10, "m"),
    ("parsec", 3.085_677_58e16, "m"),
    ("lightyear", 9.460_730_47e15, "m"),
    ("knot", 1.150_779_45, "mph"),
    ("second", 1.0, "s"),
    ("seconde", 1.0, "s"),
    ("segundo", 1.0, "s"),
    ("secondo", 1.0, "s"),
    ("sekunde", 1.0, "s"),
    ("sekunden", 1.0, "s"),
    ("sec", 1.0, "s"),
    ("msec", 1e-3, "s"),
    ("minute", 60.0, "s"),
    ("minuten", 60.0, "s"),
    ("minuto", 60.0, "s"),
    ("min", 60.0, "s"),
    ("hour", 3600.0, "s"),
    ("hr", 3600.0, "s"),
    ("heure", 3600.0, "s"),
    ("hora", 3600.0, "s"),
    ("stunde", 3600.0, "s"),
    ("stunden", 3600.0, "s"),
    ("day", 86400.0, "s"),
    ("week", 604_800.0, "s"),
    ("fortnight", 1_209_600.0, "s"),
    ("month", 2_629_800.0, "s"),
    ("year", 31_557_600.0, "s"),
    ("decade", 315_576_000.0, "s"),
    ("century", 3_155_760_000.0, "s"),
    ("centurie", 3_155_760_000.0, "s"),
    ("usec", 1e-6, "s"),
    ("μsec", 1e-6, "s"),
    ("wk", 604_800.0, "s"),
    ("yr", 31_557_600.0, "s"),
    ("gram", 1.0, "g"),
    ("gramm", 1.0, "g"),
    ("gramme", 1.0, "g"),
    ("kilo", 1000.0, "g"),
    ("tonne", 1e6, "g"),
    ("pound", 453.592_37, "g"),
    ("ounce", 28.349_523, "g"),
    ("carat", 0.2, "g"),
    ("kelvin", 1.0, "K"),
    ("newton", 1.0, "N"),
    ("dyne", 1e-5, "N"),
    ("joule", 1.0, "J"),
    ("erg", 1e-7, "J"),
    ("watt", 1.0, "W"),
    ("volt", 1.0, "V"),
    ("pascal", 1.0, "Pa"),
    ("hertz", 1.0, "Hz"),
    ("litre", 1.0, "L"),
    ("zoll", 0.0254, "m"),
    ("fuß", 0.3048, "m"),
    ("pouce", 0.0254, "m"),
    ("pollici", 0.0254, "m"),
    ("piedi", 0.3048, "m"),
    ("metri", 1.0, "m"),
    ("secondi", 1.0, "s"),
    ("minuti", 60.0, "s"),
    ("ore", 3600.0, "s"),
    ("ora", 3600.0, "s"),
    ("tag", 86400.0, "s"),
    ("tage", 86400.0, "s"),
    ("tagen", 86400.0, "s"),
    ("jour", 86400.0, "s"),
    ("día", 86400.0, "s"),
    ("giorno", 86400.0, "s"),
    ("giorni", 86400.0, "s"),
    ("woche", 604_800.0, "s"),
    ("wochen", 604_800.0, "s"),
    ("semaine", 604_800.0, "s"),
    ("semana", 604_800.0, "s"),
    ("settimane", 604_800.0, "s"),
    ("monat", 2_629_800.0, "s"),
    ("monate", 2_629_800.0, "s"),
    ("monaten", 2_629_800.0, "s"),
    ("mois", 2_629_800.0, "s"),
    ("meses", 2_629_800.0, "s"),
    ("mesi", 2_629_800.0, "s"),
    ("jahr", 31_557_600.0, "s"),
    ("jahre", 31_557_600.0, "s"),
    ("jahren", 31_557_600.0, "s"),
    ("année", 31_557_600.0, "s"),
    ("año", 31_557_600.0, "s"),
    ("anni", 31_557_600.0, "s"),
    ("tonnen", 1e6, "g"),
];

/// The prefixes of unit names.
const NAMED_PREFIXES: [(&str, i32); 24] = [
    ("pico", -12),
    ("nano", -9),
    ("micro", -6),
    ("mikro", -6),
    ("milli", -3),
    ("centi", -2),
    ("zenti", -2),
    ("deci", -1),
    ("kilo", 3),
    ("chilo", 3),
    ("kiló", 3),
    ("mili", -3),
    ("centí", -2),
    ("mega", 6),
    ("giga", 9),
    ("毫", -3),
    ("微", -6),
    ("厘", -2),
    ("分", -1),
    ("千", 3),
    ("ミリ", -3),
    ("マイクロ", -6),
    ("センチ", -2),
    ("キロ", 3),
];

/// Known units that are not supported, because mechanics lessons do not compute them or because they
/// differ by more than a factor.
const OTHER: [&str; 65] = [
    "°C",
    "°F",
    "℃",
    "℉",
    "degC",
    "degF",
    "mol",
    "cd",
    "lm",
    "lx",
    "dB",
    "px",
    "pt",
    "eV",
    "keV",
    "MeV",
    "kcal",
    "cal",
    "Ω",
    "ohm",
    "ohms",
    "mT",
    "Wb",
    "ppm",
    "bit",
    "bits",
    "byte",
    "bytes",
    "kWh",
    "celsius",
    "acre",
    "acres",
    "hectare",
    "hectares",
    "gallon",
    "gallons",
    "pint",
    "pints",
    "horsepower",
    "siemens",
    "henry",
    "farad",
    "lumen",
    "candela",
    "fahrenheit",
    "atm",
    "psi",
    "torr",
    "mmHg",
    "kgf",
    "lbf",
    "oz",
    "hp",
    "Gal",
    "dyn",
    "arcmin",
    "arcsec",
    "quintal",
    "quintals",
    "jiffy",
    "jiffies",
    "dollars",
    "euros",
    "lbm",
    "gf",
];

/// The size and the dimension of a unit without a power.
pub(crate) fn symbol(word: &str) -> Option<Dimension> {
    let row = |name: &str| UNITS.iter().chain(&NAMED).find(|row| row.0 == name);
    let lower = word.to_lowercase();
    let named = || {
        let (size, base) = named(&lower)?;
        Some((row(base)?, size))
    };
    let (row, size) = match row(word) {
        Some(row) => (row, 1.0),
        None => {
            let prefixes = PREFIXES
                .iter()
                .chain(NAMED_PREFIXES.iter().filter(|(p, _)| p.starts_with(is_wide)))
                .filter(|(p, _)| !p.is_empty());
            let mut short = prefixes.filter_map(|(prefix, power)| {
                let found = row(word.strip_prefix(prefix)?).filter(|row| row.3)?;
                Some((found, 10f64.powi(*power)))
            });
            short.next().or_else(named).or_else(|| spelled(word))?
        }
    };
    let powers = row.2.iter().map(|(base, n)| Dimension::base(*base).power(f64::from(*n)));
    let dimension = powers.into_iter().try_fold(Dimension::NUMBER, |all, one| all.product(one?))?;
    // Numbers in a larger unit are smaller.
    Some(dimension.times(1.0 / (row.1 * size)))
}

/// A symbol after a prefix that is written as a word: `millis`, `kiloN`.
fn spelled(word: &str) -> Option<(&'static UnitRow, f64)> {
    let mut found =
        NAMED_PREFIXES.iter().filter(|(p, _)| !p.starts_with(is_wide)).filter_map(|(prefix, power)| {
            let (head, tail) = word.split_at_checked(prefix.len())?;
            let row = UNITS.iter().find(|row| row.3 && row.0 == tail)?;
            head.eq_ignore_ascii_case(prefix).then_some((row, 10f64.powi(*power)))
        });
    found.next()
}

/// A unit by its name in lower case: its size, and the symbol in whose unit the size is.
fn named(word: &str) -> Option<(f64, &'static str)> {
    let one =
        |word: &str| WORDS.iter().find(|(name, ..)| *name == word).map(|(_, size, base)| (*size, *base));
    let any = |word: &str| one(word).or_else(|| one(word.strip_suffix('s')?));
    any(word).or_else(|| {
        let mut prefixed =
            NAMED_PREFIXES.iter().filter(|(p, _)| !p.starts_with(is_wide)).filter_map(|(prefix, power)| {
                let (size, base) = any(word.strip_prefix(prefix)?)?;
                Some((size * 10f64.powi(*power), base))
            });
        prefixed.next()
    })
}

/// Whether this is a known unit that is not supported.
pub(crate) fn is_other(word: &str) -> bool {
    OTHER.contains(&word) || word.len() > 3 && OTHER.contains(&word.to_lowercase().as_str())
}

/// Whether the letter belongs to a script without spaces between words.
pub fn is_wide(c: char) -> bool {
    matches!(c, '\u{3005}'..='\u{30ff}' | '\u{3400}'..='\u{9fff}' | '\u{f900}'..='\u{faff}' | '\u{ff66}'..='\u{ff9f}')
}
