//! From names to channels: which field of a row feeds which quantity, and what the options change about it.

use super::error::ReadErrorKind;
use super::options::ReadOptions;
use super::options::{FixedChannel, Target};
use super::samples::MAX_COLUMNS;
use super::units::{ISO, Name, Quantity, Unit};
use super::wording::{shell_quoted, shown_name};

/// Where one quantity comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Source {
    /// A field of the row: `unit.si(gain * value + bias)`.
    Field {
        /// Index into the values of the fields that are used.
        slot: usize,
        gain: f64,
        bias: f64,
        unit: &'static Unit,
    },
    /// A constant, in SI.
    Fixed(f64),
}

/// How to read a row.
#[derive(Debug, Clone)]
pub(crate) struct Plan {
    /// Per field, the slot that takes its value.
    pub(crate) fields: Vec<Option<usize>>,
    /// Names of the fields.
    pub(crate) names: Vec<String>,
    /// Per quantity, in the order of [`Quantity::ALL`].
    pub(crate) sources: [Option<Source>; MAX_COLUMNS],
    /// Columns that nothing uses.
    pub(crate) ignored: Vec<String>,
    /// The slot that holds dates, and the one that they are counted from, in s.
    pub(crate) dates: Option<(usize, f64)>,
}

impl Plan {
    /// Counts dates from the first of them, which `stamps_s` holds by field: seconds since 1970 have few digits to spare.
    pub(crate) fn count_from(&mut self, stamps_s: &[Option<f64>]) {
        if let Some(Source::Field { slot, unit, .. }) = self.sources[Quantity::Time as usize]
            && unit.symbol == ISO
        {
            let field = self.fields.iter().position(|field| *field == Some(slot));
            let first_s = field.and_then(|field| stamps_s.get(field).copied().flatten()).unwrap_or(0.0);
            self.dates = Some((slot, first_s));
        }
    }

    /// The field, counted from 1, that holds time.
    pub(crate) fn time_column(&self) -> u64 {
        let Some(Source::Field { slot, .. }) = self.sources[0] else { return 1 };
        self.fields.iter().position(|field| *field == Some(slot)).map_or(1, |index| index as u64 + 1)
    }

    pub(crate) fn has(&self, quantity: Quantity) -> bool {
        self.sources[quantity as usize].is_some()
    }
}

/// A reason, and the field (counted from 0) that it is about.
#[derive(Debug)]
pub(crate) struct HeaderFault {
    pub(crate) field: Option<usize>,
    pub(crate) kind: ReadErrorKind,
}

impl From<ReadErrorKind> for HeaderFault {
    fn from(kind: ReadErrorKind) -> Self {
        Self { field: None, kind }
    }
}

/// One column that was given a meaning, and by what.
#[derive(Debug, Clone)]
struct Assigned {
    field: usize,
    /// As the user wrote it: the name of the column, or the option.
    origin: String,
    /// Whether an option gave it, on the command line or in a file.
    by_option: bool,
    gain: f64,
    bias: f64,
    unit: &'static Unit,
}

/// Gives every column a meaning. `names` has `None` where a column is to be skipped. Options come before names:
/// a column that an option uses means only what the option says, and a name that an option supplies is not
/// looked for among the others.
pub(crate) fn plan(names: &[Option<String>], options: &ReadOptions) -> Result<Plan, HeaderFault> {
    let shown: Vec<String> = names.iter().map(|name| shown_name(name.as_deref().unwrap_or("-"))).collect();
    let listed: Vec<String> =
        names.iter().zip(&shown).filter(|(name, _)| name.is_some()).map(|(_, shown)| shown.clone()).collect();
    let mut assigned: [Option<Assigned>; MAX_COLUMNS] = Default::default();
    let mut taken = vec![false; names.len()];
    from_options(names, options, &listed, &mut assigned, &mut taken)?;
    let by_option: [bool; MAX_COLUMNS] = std::array::from_fn(|index| assigned[index].is_some());
    from_names(names, &shown, by_option, &mut assigned, &mut taken)?;

    let mut sources = assemble(&assigned, names.len());
    let fixed = fixed_channels(options, &assigned)?;
    for (source, value) in sources.1.iter_mut().zip(fixed) {
        if let Some(value) = value {
            *source = Some(Source::Fixed(value));
        }
    }
    let (fields, sources) = sources;
    resembling(names, &shown, &taken, &sources)?;
    for quantity in Quantity::ALL {
        let needed = match quantity {
            Quantity::Temperature => false,
            Quantity::Force => options.force_required,
            _ => true,
        };
        if needed && sources[quantity as usize].is_none() {
            let hint = hint(quantity, names, &taken);
            return Err(ReadErrorKind::Missing { quantity, columns: listed, hint }.into());
        }
    }
    let ignored = names
        .iter()
        .zip(&taken)
        .zip(&shown)
        .filter(|((name, taken), shown)| name.is_some() && !**taken && !shown.is_empty())
        .map(|(_, shown)| shown.clone())
        .collect();
    Ok(Plan { fields, names: shown, sources, ignored, dates: None })
}

/// Columns that `--map` and `--calibrate` name.
fn from_options(
    names: &[Option<String>],
    options: &ReadOptions,
    listed: &[String],
    assigned: &mut [Option<Assigned>; MAX_COLUMNS],
    taken: &mut [bool],
) -> Result<(), HeaderFault> {
    let maps = options.map.iter().map(|map| (("--map", &map.name, None), &map.original, map.target, 1.0, 0.0));
    let calibrations = options
        .calibrate
        .iter()
        .map(|c| (("--calibrate", &c.name, c.origin.as_ref()), &c.original, c.target, c.gain, c.offset));
    for ((option, name, file), original, Target { quantity, unit }, gain, bias) in maps.chain(calibrations) {
        let field = find(names, original, file.map_or(option, String::as_str), listed)?;
        let origin = file.cloned().unwrap_or_else(|| format!("{option} {name}"));
        if let Some(first) = &assigned[quantity as usize] {
            let first = first.origin.clone();
            return Err(ReadErrorKind::OptionTwice { quantity, first, second: origin }.into());
        }
        assigned[quantity as usize] = Some(Assigned { field, origin, by_option: true, gain, bias, unit });
        taken[field] = true;
    }
    Ok(())
}

/// The field called `original`: exactly, or else whatever its case.
fn find(names: &[Option<String>], original: &str, option: &str, listed: &[String]) -> Result<usize, ReadErrorKind> {
    let original = original.trim();
    let matching = |same: &dyn Fn(&str) -> bool| -> Vec<usize> {
        let named = names.iter().enumerate().filter_map(|(index, name)| Some((index, name.as_deref()?)));
        named.filter(|(_, name)| same(name)).map(|(index, _)| index).collect()
    };
    let exact = matching(&|name| name == original);
    let found = if exact.is_empty() { matching(&|name| name.eq_ignore_ascii_case(original)) } else { exact };
    let shown = shown_name(original);
    match found.as_slice() {
        [field] => Ok(*field),
        [] => {
            let lower = shown.to_lowercase();
            let nearest = listed
                .iter()
                .map(|name| (strsim::osa_distance(&lower, &name.to_lowercase()), name))
                .filter(|(distance, name)| 2 * *distance <= name.chars().count())
                .min_by_key(|(distance, _)| *distance)
                .map(|(_, name)| name.clone());
            Err(ReadErrorKind::NoSuchColumn {
                option: option.to_owned(),
                original: shown,
                nearest,
                columns: listed.to_vec(),
            })
        }
        _ => Err(ReadErrorKind::AmbiguousColumn { option: option.to_owned(), original: shown }),
    }
}

/// Columns whose names say what they are.
fn from_names(
    names: &[Option<String>],
    shown: &[String],
    by_option: [bool; MAX_COLUMNS],
    assigned: &mut [Option<Assigned>; MAX_COLUMNS],
    taken: &mut [bool],
) -> Result<(), HeaderFault> {
    for (field, name) in names.iter().enumerate() {
        let Some(name) = name.as_deref().filter(|_| !taken[field]) else { continue };
        let Name::Channel(quantity, unit) = Name::read(name) else { continue };
        if by_option[quantity as usize] {
            continue;
        }
        if let Some(first) = &assigned[quantity as usize] {
            let (first, second) = (first.origin.clone(), shown[field].clone());
            return Err(HeaderFault { field: Some(field), kind: ReadErrorKind::Twice { quantity, first, second } });
        }
        let origin = shown[field].clone();
        assigned[quantity as usize] = Some(Assigned { field, origin, by_option: false, gain: 1.0, bias: 0.0, unit });
        taken[field] = true;
    }
    Ok(())
}

/// Numbers the fields that are used.
fn assemble(
    assigned: &[Option<Assigned>; MAX_COLUMNS],
    n_fields: usize,
) -> (Vec<Option<usize>>, [Option<Source>; MAX_COLUMNS]) {
    let mut fields = vec![None; n_fields];
    let mut n_slots = 0;
    let mut sources = [None; MAX_COLUMNS];
    for (source, assigned) in sources.iter_mut().zip(assigned) {
        let Some(assigned) = assigned else { continue };
        let slot = *fields[assigned.field].get_or_insert_with(|| {
            n_slots += 1;
            n_slots - 1
        });
        *source = Some(Source::Field { slot, gain: assigned.gain, bias: assigned.bias, unit: assigned.unit });
    }
    (fields, sources)
}

/// Constants, in SI, per quantity.
fn fixed_channels(
    options: &ReadOptions,
    assigned: &[Option<Assigned>; MAX_COLUMNS],
) -> Result<[Option<f64>; MAX_COLUMNS], ReadErrorKind> {
    let mut values = [None; MAX_COLUMNS];
    for (index, fixed) in options.fixed.iter().enumerate() {
        let quantity = fixed.quantity;
        let option = |fixed: &FixedChannel| fixed.origin.clone().unwrap_or_else(|| format!("--fixed {}", fixed.name));
        if let Some(Assigned { origin, by_option, .. }) = &assigned[quantity as usize] {
            return Err(if *by_option {
                ReadErrorKind::OptionTwice { quantity, first: origin.clone(), second: option(fixed) }
            } else {
                ReadErrorKind::FixedClash { option: option(fixed), column: origin.clone(), quantity }
            });
        }
        if let Some(first) = options.fixed[..index].iter().find(|other| other.quantity == quantity) {
            let (first, second) = (option(first), option(fixed));
            return Err(ReadErrorKind::OptionTwice { quantity, first, second });
        }
        values[quantity as usize] = Some(fixed.value);
    }
    Ok(values)
}

/// Refuses a column that nearly is a quantity which nothing supplies. Where the quantity is there, a column
/// that resembles it (`force_raw` beside `force_N`) is one of those kept out of the way.
fn resembling(
    names: &[Option<String>],
    shown: &[String],
    taken: &[bool],
    sources: &[Option<Source>; MAX_COLUMNS],
) -> Result<(), HeaderFault> {
    for (field, name) in names.iter().enumerate() {
        let Some(name) = name.as_deref().filter(|_| !taken[field]) else { continue };
        let read = Name::read(name);
        if read.quantity().is_none_or(|quantity| sources[quantity as usize].is_some()) {
            continue;
        }
        let name = shown[field].clone();
        let kind = match read {
            Name::UnitMissing(quantity) => ReadErrorKind::UnitMissing { name, quantity },
            Name::UnitUnknown(quantity, unit) => ReadErrorKind::UnknownUnit { name, unit: shown_name(&unit), quantity },
            Name::Misspelt(_, suggestion) => ReadErrorKind::UnknownColumn { name, suggestion },
            Name::Channel(..) | Name::Other => continue,
        };
        return Err(HeaderFault { field: Some(field), kind });
    }
    Ok(())
}

/// An option that would supply `quantity` from the only unused column in one of its units: `P [bar]`, `p_kPa`.
fn hint(quantity: Quantity, names: &[Option<String>], taken: &[bool]) -> Option<String> {
    let unused = names.iter().zip(taken).filter(|(_, taken)| !**taken).filter_map(|(name, _)| name.as_deref());
    let mut fitting = unused.filter_map(|name| {
        let (_, last) =
            name.trim_end_matches(|c: char| !c.is_alphanumeric()).rsplit_once(|c: char| !c.is_alphanumeric())?;
        let unit = quantity.unit(last)?;
        Some(format!("--map {quantity}_{}={}", unit.symbol, shell_quoted(&shown_name(name))))
    });
    let only = fitting.next()?;
    fitting.next().is_none().then_some(only)
}
