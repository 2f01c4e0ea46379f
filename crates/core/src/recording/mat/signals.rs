//! Which of the values are columns of a recording, and what they are called.
//!
//! | in the file                                             | column                                            |
//! |---------------------------------------------------------|---------------------------------------------------|
//! | vector `p_meas`                                         | `p_meas`                                          |
//! | matrix `data` of `n × 4`                                | `data(:,1)` to `data(:,4)`                        |
//! | structure `log` with vector `p_meas`                    | `p_meas` or `log.p_meas`                          |
//! | Simulink's structure with time: `out.time`, `out.signals(2).values` with a label | `time_s`, the label, or the path |
//! | a time series as a structure: `p.Time`, `p.Data`        | `p.Time`, `p` or `p.Data`                         |
//! | dSPACE: `rec.Y(2)` with `Name`, `Unit`, `Data`          | the name with its unit, the name, or `rec.Y(2).Data` |
//! | dSPACE: `rec.X` with `Unit` s and `Data`                | `time_s` or `rec.X.Data`                          |
//!
//! Simulink's time is in seconds, always; of all else the unit is in the name, in the file beside it, or asked for.

use std::collections::BTreeMap;

use super::super::units::{Name, Quantity};
use super::array::{Numbers, Structure, Value, Variable};

/// Columns of a matrix that are given names.
const MAX_MATRIX_COLUMNS: usize = 256;

/// A column: samples within an array.
#[derive(Debug, Clone)]
pub(super) struct Column<'a> {
    /// What it may be called, the best first.
    names: Vec<String>,
    numbers: Numbers<'a>,
    first: usize,
    step: usize,
    pub(super) n_samples: usize,
}

impl Column<'_> {
    /// Sample `index`.
    pub(super) fn get(&self, index: usize) -> f64 {
        self.numbers.get(self.first + index * self.step)
    }

    fn samples(&self) -> impl Iterator<Item = u64> {
        (0..self.n_samples).map(|index| self.get(index).to_bits())
    }
}

/// What a file has to offer.
#[derive(Debug, Default)]
pub(super) struct Signals<'a> {
    pub(super) columns: Vec<Column<'a>>,
    /// Variables that are objects, and their classes.
    pub(super) objects: Vec<(String, String)>,
}

impl<'a> Signals<'a> {
    /// Looks at the variables of a file.
    pub(super) fn of(variables: &[Variable<'a>]) -> Self {
        let mut signals = Self::default();
        for variable in variables {
            signals.value(&variable.value, &variable.name, &[]);
        }
        signals.drop_equal_times();
        signals
    }

    /// Names of the columns: what one of `wanted` asks for, or else the best that no other column has.
    pub(super) fn names(&self, wanted: &[&str]) -> Vec<Option<String>> {
        let asked = |name: &&String| wanted.iter().any(|wanted| wanted.eq_ignore_ascii_case(name));
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for name in self.columns.iter().flat_map(|column| &column.names) {
            *counts.entry(name).or_default() += 1;
        }
        let unique = |name: &&String| counts.get(name.as_str()) == Some(&1);
        self.columns
            .iter()
            .map(|column| {
                let mut names = column.names.iter();
                names.clone().find(asked).or_else(|| names.clone().find(unique)).or(names.next_back()).cloned()
            })
            .collect()
    }

    /// `better` names come before the path.
    fn value(&mut self, value: &Value<'a>, path: &str, better: &[String]) {
        match value {
            Value::Numbers(numbers) => self.numbers(numbers, path, better),
            Value::Structure(structure) => {
                let n_elements = structure.elements.len();
                for index in 0..n_elements {
                    let path = if n_elements == 1 { path.to_owned() } else { format!("{path}({})", index + 1) };
                    self.structure(structure, index, &path);
                }
            }
            Value::Cells(cells) => {
                for (index, cell) in cells.iter().enumerate() {
                    self.value(cell, &format!("{path}{{{}}}", index + 1), &[]);
                }
            }
            Value::Object(class) => self.objects.push((path.to_owned(), class.clone())),
            Value::Text(_) | Value::Other => {}
        }
    }

    fn numbers(&mut self, numbers: &Numbers<'a>, path: &str, better: &[String]) {
        let Numbers { n_rows, n_columns, .. } = *numbers;
        let column =
            |names: Vec<String>, first, step, n_samples| Column { names, numbers: *numbers, first, step, n_samples };
        // A single number is a constant, which --fixed is for.
        if numbers.len() < 2 {
            return;
        }
        if n_rows == 1 || n_columns == 1 {
            let mut names: Vec<String> = better.iter().cloned().chain([path.to_owned()]).collect();
            names.dedup();
            self.columns.push(column(names, 0, 1, numbers.len()));
        } else if n_rows >= n_columns {
            // Samples go along the longer side.
            for index in 0..n_columns.min(MAX_MATRIX_COLUMNS) {
                let names = vec![format!("{path}(:,{})", index + 1)];
                self.columns.push(column(names, index * n_rows, 1, n_rows));
            }
        } else {
            for index in 0..n_rows.min(MAX_MATRIX_COLUMNS) {
                let names = vec![format!("{path}({},:)", index + 1)];
                self.columns.push(column(names, index, n_rows, n_columns));
            }
        }
    }

    /// One structure.
    fn structure(&mut self, structure: &Structure<'a>, index: usize, path: &str) {
        let field = |name: &str| structure.field(index, name);
        let at = |name: &str| format!("{path}.{name}");
        let text = |name: &str| match field(name) {
            Some(Value::Text(text)) => text.trim().trim_matches('"').to_owned(),
            _ => String::new(),
        };
        let before_dot = path.rsplit('.').next().unwrap_or(path).to_owned();
        if let (Some(time @ Value::Numbers(_)), Some(Value::Structure(signals))) = (field("time"), field("signals")) {
            self.value(time, &at("time"), &[seconds()]);
            let n_signals = signals.elements.len();
            for signal in 0..n_signals {
                let Some(values) = signals.field(signal, "values") else { continue };
                let place = if n_signals == 1 { String::new() } else { format!("({})", signal + 1) };
                let mut better = match signals.field(signal, "label") {
                    Some(Value::Text(label)) if !label.trim().is_empty() => vec![label.trim().to_owned()],
                    _ => Vec::new(),
                };
                if n_signals == 1 {
                    better.push(before_dot.clone());
                }
                self.value(values, &format!("{path}.signals{place}.values"), &better);
            }
        } else if let (Some(time @ Value::Numbers(_)), Some(data @ Value::Numbers(_))) = (field("Time"), field("Data"))
        {
            let in_seconds = match field("TimeInfo") {
                Some(Value::Structure(info)) => {
                    matches!(info.field(0, "Units"), Some(Value::Text(units)) if units == "seconds")
                }
                _ => false,
            };
            let better = if in_seconds { vec![seconds()] } else { Vec::new() };
            self.value(time, &at("Time"), &better);
            self.value(data, &at("Data"), &[before_dot]);
        } else if let (Some(Value::Text(_)), Some(data @ Value::Numbers(_))) = (field("Name"), field("Data")) {
            let (name, unit) = (text("Name"), text("Unit"));
            let mut better = Vec::new();
            if let (Name::UnitMissing(_), false) = (Name::read(&name), unit.is_empty()) {
                better.push(format!("{name}_{unit}"));
            }
            let is_axis = path.split('(').next().is_some_and(|path| path.ends_with(".X"));
            if !name.is_empty() {
                better.push(name);
            } else if is_axis && Quantity::Time.unit(&unit).is_some() {
                better.push(format!("{}_{unit}", Quantity::Time));
            }
            self.value(data, &at("Data"), &better);
        } else {
            for (name, value) in structure.fields.iter().zip(structure.elements.get(index).into_iter().flatten()) {
                self.value(value, &at(name), std::slice::from_ref(name));
            }
        }
    }

    /// Simulink writes the same time beside every signal: one column is enough, under every one of its names.
    fn drop_equal_times(&mut self) {
        let is_time = |column: &Column<'_>| column.names.first().is_some_and(|name| *name == seconds());
        let Some(first) = self.columns.iter().position(is_time) else { return };
        let later = self.columns.split_off(first + 1);
        for column in later {
            let kept = &mut self.columns[first];
            if is_time(&column) && column.samples().eq(kept.samples()) {
                kept.names.extend(column.names.into_iter().skip(1));
            } else {
                self.columns.push(column);
            }
        }
    }
}

/// The name of a time that is in seconds.
fn seconds() -> String {
    format!("{}_s", Quantity::Time)
}
