//! `pam-channels/1`: a file that says once, for all programs, what the columns of a bench's recordings mean.
//!
//! One table for each quantity: where it comes from (a column, or a value that was constant), its unit, the line that
//! turns a transducer's reading into that unit, and the ends of its sensor's range. Options on the command line win over it,
//! quantity by quantity.

use std::path::{Path, PathBuf};

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::digest::sha256_hex;
use super::options::{Calibration, Columns, FixedChannel, OptionSyntaxError, ReadOptions, Target};
use super::samples::MAX_COLUMNS;
use super::units::Quantity;
use super::wording::shown_name;
use crate::spelling::{nearest, place_in};
use crate::toml_file::{self, TomlFileError};

/// Schema name and version.
pub const SCHEMA: &str = "pam-channels/1";

/// What the columns of a bench's recordings mean, as the file has it (TOML).
#[derive(Debug, Clone, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ChannelsFile {
    /// `pam-channels/1`, where it is given.
    #[cfg_attr(feature = "schemas", schemars(extend("const" = SCHEMA), with = "Option<String>"))]
    schema: Option<Spanned<String>>,
    /// Names of the columns, in their order, for recordings without a header; `-` skips one.
    #[cfg_attr(feature = "schemas", schemars(with = "Option<Vec<String>>"))]
    columns: Option<Spanned<Vec<String>>>,
    /// Time since any origin.
    #[cfg_attr(feature = "schemas", schemars(with = "Option<Channel>"))]
    time: Option<Spanned<Channel>>,
    /// Gauge pressure in the muscle.
    #[cfg_attr(feature = "schemas", schemars(with = "Option<Channel>"))]
    pressure: Option<Spanned<Channel>>,
    /// Length, clamp to clamp.
    #[cfg_attr(feature = "schemas", schemars(with = "Option<Channel>"))]
    length: Option<Spanned<Channel>>,
    /// Tension, positive when the muscle pulls.
    #[cfg_attr(feature = "schemas", schemars(with = "Option<Channel>"))]
    force: Option<Spanned<Channel>>,
    /// Temperature of the muscle.
    #[cfg_attr(feature = "schemas", schemars(with = "Option<Channel>"))]
    temperature: Option<Spanned<Channel>>,
}

/// Where one quantity comes from.
#[derive(Debug, Clone, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
struct Channel {
    /// Unit of the quantity: s, kPa, bar, mm, N and so on.
    unit: String,
    /// Column of the recording; by default the one that is called after quantity and unit.
    column: Option<String>,
    /// A value that was constant and not recorded, in `unit`.
    value: Option<f64>,
    /// Units per unit of the column's reading; 1 where it is not given.
    gain: Option<f64>,
    /// Quantity at a reading of zero, in `unit`; 0 where it is not given.
    offset: Option<f64>,
    /// Ends of the sensor's range, in `unit`: samples at or beyond them are excluded from fits and statistics.
    range: Option<[f64; 2]>,
}

/// Why a channels file is refused.
#[derive(Debug, thiserror::Error)]
pub enum ChannelsError {
    /// It cannot be read, or is no TOML of its kind.
    #[error(transparent)]
    File(#[from] TomlFileError),
    /// A table, or a list, that cannot be used.
    #[error("{}:{line}:{column}: {fault}", path.display())]
    Entry {
        /// File being read.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// What is wrong there.
        fault: ChannelFault,
    },
}

/// What is wrong with a table of a channels file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ChannelFault {
    /// Another schema.
    #[error("schema is \"{found}\"; write schema = \"{SCHEMA}\", or leave it out")]
    Schema {
        /// Schema found.
        found: String,
    },
    /// The list of columns cannot be understood.
    #[error("columns: {fault}")]
    Columns {
        /// What is wrong with it.
        fault: OptionSyntaxError,
    },
    /// A unit that the quantity does not have.
    #[error(
        "[{quantity}] has the unit \"{unit}\", which is not known; {}write {}, and gain and offset for any other",
        near.as_ref().map(|near| format!("did you mean \"{near}\"? Else ")).unwrap_or_default(),
        quantity.unit_list()
    )]
    Unit {
        /// The quantity.
        quantity: Quantity,
        /// Unit found.
        unit: String,
        /// The one that was probably meant.
        near: Option<&'static str>,
    },
    /// A column and a constant.
    #[error("[{quantity}] has both a column and a value; leave one of them out")]
    Both {
        /// The quantity.
        quantity: Quantity,
    },
    /// A gain, an offset or a range of a constant.
    #[error("[{quantity}] has a value, which takes no {key}; leave it out")]
    OfValue {
        /// The quantity.
        quantity: Quantity,
        /// The key.
        key: &'static str,
    },
    /// A gain or an offset of no column.
    #[error("[{quantity}] has {key} but no column that it belongs to; add column = \"…\"")]
    NoColumn {
        /// The quantity.
        quantity: Quantity,
        /// The key.
        key: &'static str,
    },
    /// A number that is none, or a gain of zero.
    #[error("[{quantity}] has {key} = {value}, which leaves nothing of the reading; write a finite number{}", if *key == "gain" { " other than 0" } else { "" })]
    Number {
        /// The quantity.
        quantity: Quantity,
        /// The key.
        key: &'static str,
        /// Its value.
        value: f64,
    },
    /// A range whose ends are not ascending.
    #[error("[{quantity}] has the range {low} to {high}; write the lower end first, as in range = [0, 1000]")]
    Range {
        /// The quantity.
        quantity: Quantity,
        /// First end.
        low: f64,
        /// Second end.
        high: f64,
    },
    /// A range of what is no transducer's.
    #[error("[{quantity}] takes no range, which only pressure and force have; leave it out")]
    NoSensor {
        /// The quantity.
        quantity: Quantity,
    },
    /// Time as a constant.
    #[error("[time] cannot be a value; name the column that holds it")]
    FixedTime,
}

/// A channels file, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Channels {
    columns: Option<Columns>,
    sources: [Option<ChannelSource>; MAX_COLUMNS],
    ranges: [Option<[f64; 2]>; MAX_COLUMNS],
    /// SHA-256 of the file, hexadecimal.
    pub sha256: String,
}

#[derive(Debug, Clone, PartialEq)]
enum ChannelSource {
    Column(Calibration),
    Value(FixedChannel),
}

impl Channels {
    /// Reads and checks a channels file.
    ///
    /// # Errors
    /// [`ChannelsError`] names the file and the line, and what to do.
    pub fn read(path: &Path) -> Result<Self, ChannelsError> {
        let text = toml_file::read_text(path, "channels file")?;
        Self::parse(&text, path)
    }

    /// Parses the text of a channels file; `path` is for messages.
    ///
    /// # Errors
    /// As [`Channels::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, ChannelsError> {
        let file: ChannelsFile = toml_file::parse(text, path)?;
        let refuse = |start: usize, fault| {
            let (line, column) = place_in(text, start);
            ChannelsError::Entry { path: path.to_owned(), line, column, fault }
        };
        if let Some(schema) = file.schema.as_ref().filter(|schema| schema.as_ref() != SCHEMA) {
            return Err(refuse(schema.span().start, ChannelFault::Schema { found: shown_name(schema.as_ref()) }));
        }
        let columns = file
            .columns
            .map(|names| {
                let start = names.span().start;
                let columns = Columns::of(names.as_ref().iter().map(String::as_str))
                    .map_err(|fault| refuse(start, ChannelFault::Columns { fault }))?;
                Ok::<_, ChannelsError>(Columns { if_no_header: true, ..columns })
            })
            .transpose()?;
        let mut channels = Self {
            columns,
            sources: Default::default(),
            ranges: [None; MAX_COLUMNS],
            sha256: sha256_hex(text.as_bytes()),
        };
        let tables = [file.time, file.pressure, file.length, file.force, file.temperature];
        for (quantity, table) in Quantity::ALL.into_iter().zip(tables) {
            let Some(table) = table else { continue };
            let start = table.span().start;
            let origin = format!("{} [{quantity}]", path.display());
            let (source, range) =
                checked(quantity, table.into_inner(), origin).map_err(|fault| refuse(start, fault))?;
            channels.sources[quantity as usize] = source;
            channels.ranges[quantity as usize] = range;
        }
        Ok(channels)
    }

    /// Adds to `options` what they do not say themselves.
    pub fn complete(&self, options: &mut ReadOptions) {
        if options.columns.is_none() {
            options.columns.clone_from(&self.columns);
        }
        for (quantity, source) in Quantity::ALL.into_iter().zip(&self.sources) {
            match source {
                _ if options.supply(quantity) => {}
                Some(ChannelSource::Column(line)) => options.calibrate.push(line.clone()),
                Some(ChannelSource::Value(fixed)) => options.fixed.push(fixed.clone()),
                None => {}
            }
        }
        options.sensor_ranges = self.ranges;
    }
}

/// Where a quantity comes from and the ends of its sensor's range, in SI.
fn checked(
    quantity: Quantity,
    table: Channel,
    origin: String,
) -> Result<(Option<ChannelSource>, Option<[f64; 2]>), ChannelFault> {
    let Some(unit) = quantity.unit(&table.unit) else {
        let near = nearest(&table.unit, quantity.units().iter().map(|unit| unit.symbol));
        let near = near.and_then(|near| quantity.unit(near)).map(|unit| unit.symbol);
        return Err(ChannelFault::Unit { quantity, unit: shown_name(&table.unit), near });
    };
    let numbers = [("value", table.value), ("gain", table.gain), ("offset", table.offset)];
    for (key, value) in numbers.into_iter().filter_map(|(key, value)| Some((key, value?))) {
        if !value.is_finite() || (key == "gain" && value == 0.0) {
            return Err(ChannelFault::Number { quantity, key, value });
        }
    }
    let given = [("gain", table.gain.is_some()), ("offset", table.offset.is_some()), ("range", table.range.is_some())];
    let first = |n: usize| given.iter().take(n).find(|(_, given)| *given).map(|(key, _)| *key);
    if let Some([low, high]) = table.range {
        if !matches!(quantity, Quantity::Pressure | Quantity::Force) {
            return Err(ChannelFault::NoSensor { quantity });
        }
        if low.is_nan() || high.is_nan() || low >= high {
            return Err(ChannelFault::Range { quantity, low, high });
        }
    }
    let target = Target { quantity, unit };
    let name = format!("{quantity}_{}", unit.symbol);
    let source = match (table.column, table.value) {
        (Some(_), Some(_)) => return Err(ChannelFault::Both { quantity }),
        (None, Some(_)) if quantity == Quantity::Time => return Err(ChannelFault::FixedTime),
        (None, Some(value)) => {
            if let Some(key) = first(3) {
                return Err(ChannelFault::OfValue { quantity, key });
            }
            Some(ChannelSource::Value(FixedChannel { name, quantity, value: unit.si(value), origin: Some(origin) }))
        }
        (Some(original), None) => {
            let (gain, offset) = (table.gain.unwrap_or(1.0), table.offset.unwrap_or(0.0));
            Some(ChannelSource::Column(Calibration { name, original, gain, offset, target, origin: Some(origin) }))
        }
        (None, None) => {
            if let Some(key) = first(2) {
                return Err(ChannelFault::NoColumn { quantity, key });
            }
            None
        }
    };
    Ok((source, table.range.map(|ends| ends.map(|end| unit.si(end)))))
}

#[cfg(test)]
mod tests {
    use insta::assert_snapshot;

    use super::*;

    fn refusal(text: &str) -> String {
        Channels::parse(text, Path::new("bench.toml")).unwrap_err().to_string()
    }

    #[test]
    fn options_win_over_the_file_quantity_by_quantity() {
        let text = "schema = \"pam-channels/1\"\ncolumns = [\"t\", \"-\"]\n[pressure]\ncolumn = \"ai0\"\nunit = \"bar\"\n\
                    gain = 2.0\nrange = [0, 10]\n[length]\nvalue = 126.75\nunit = \"mm\"\n";
        let channels = Channels::parse(text, Path::new("bench.toml")).unwrap();
        let mut options = ReadOptions::default();
        channels.complete(&mut options);
        assert_eq!((options.calibrate[0].gain, options.calibrate[0].offset), (2.0, 0.0));
        assert_eq!(options.fixed[0].value, 0.12675);
        assert_eq!(options.sensor_ranges[Quantity::Pressure as usize], Some([0.0, 1e6]));
        let mut options = ReadOptions {
            map: vec!["pressure_kPa=p".parse().unwrap()],
            fixed: vec!["length_m=0.1".parse().unwrap()],
            columns: Some("a,b".parse().unwrap()),
            ..ReadOptions::default()
        };
        channels.complete(&mut options);
        assert!(options.calibrate.is_empty());
        assert_eq!((options.fixed.len(), options.fixed[0].value), (1, 0.1));
        assert_eq!(options.columns.unwrap().names[1].as_deref(), Some("b"));
    }

    #[test]
    fn the_shipped_example_is_right() {
        Channels::parse(include_str!("../../../configs/bench.toml"), Path::new("bench.toml")).unwrap();
    }

    #[test]
    fn every_mistake_gets_its_place_and_the_remedy() {
        assert_snapshot!(refusal("[pressure]\ncolum = \"x\"\n"), @"bench.toml:2:1: unknown field `colum`; did you mean `column`?");
        assert_snapshot!(refusal("[presure]\nunit = \"bar\"\n"), @"bench.toml:1:2: unknown field `presure`; did you mean `pressure`?");
        assert_snapshot!(refusal("[force]\ncolumn = \"x\"\n"), @"bench.toml:1:1: missing field `unit`");
        assert_snapshot!(refusal("\n[pressure]\nunit = \"Bahr\"\n"), @r#"bench.toml:2:1: [pressure] has the unit "Bahr", which is not known; did you mean "bar"? Else write kPa, Pa, MPa, bar or psi, and gain and offset for any other"#);
        assert_snapshot!(refusal("[force]\nunit = \"N\"\ncolumn = \"a\"\nvalue = 1\n"), @"bench.toml:1:1: [force] has both a column and a value; leave one of them out");
        assert_snapshot!(refusal("[force]\nunit = \"N\"\nvalue = 1\ngain = 2\n"), @"bench.toml:1:1: [force] has a value, which takes no gain; leave it out");
        assert_snapshot!(refusal("[force]\nunit = \"N\"\noffset = 1\n"), @r#"bench.toml:1:1: [force] has offset but no column that it belongs to; add column = "…""#);
        assert_snapshot!(refusal("[force]\nunit = \"N\"\ncolumn = \"a\"\ngain = 0\n"), @"bench.toml:1:1: [force] has gain = 0, which leaves nothing of the reading; write a finite number other than 0");
        assert_snapshot!(refusal("[force]\nunit = \"N\"\nrange = [5, 5]\n"), @"bench.toml:1:1: [force] has the range 5 to 5; write the lower end first, as in range = [0, 1000]");
        assert_snapshot!(refusal("[length]\nunit = \"mm\"\nrange = [0, 5]\n"), @"bench.toml:1:1: [length] takes no range, which only pressure and force have; leave it out");
        assert_snapshot!(refusal("[time]\nunit = \"s\"\nvalue = 5\n"), @"bench.toml:1:1: [time] cannot be a value; name the column that holds it");
        assert_snapshot!(refusal("schema = \"pam-model/1\"\n"), @r#"bench.toml:1:10: schema is "pam-model/1"; write schema = "pam-channels/1", or leave it out"#);
        assert_snapshot!(refusal("columns = [\"a\", \"\"]\n"), @"bench.toml:1:11: columns: column 2 has no name; write - to skip a column, as in force_N,pressure_kPa,time_s,-");
    }
}
