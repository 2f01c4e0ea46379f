//! Columns among the values, and their labels.
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

use super::array::{Numbers, Structure, Value, Variable};

/// Columns of a matrix that are given names.
const MAX_MATRIX_COLUMNS: usize = 256;

/// A name that a column may have.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Label {
    /// As it stands in the file.
    Name(String),
    /// A name and the unit beside it.
    WithUnit {
        /// The name.
        name: String,
        /// The unit, as the file spells it.
        unit: String,
    },
    /// Time, in this unit.
    Time {
        /// The unit, as the file spells it.
        unit: String,
    },
}

/// A column: samples within an array.
#[derive(Debug, Clone)]
pub struct Column<'a> {
    /// Its names, the best first.
    pub labels: Vec<Label>,
    numbers: Numbers<'a>,
    first: usize,
    step: usize,
    n_samples: usize,
}

impl Column<'_> {
    /// Number of samples.
    #[expect(clippy::len_without_is_empty, reason = "a column has two samples or more")]
    pub fn len(&self) -> usize {
        self.n_samples
    }

    /// Sample `index`; NaN where there is none.
    pub fn get(&self, index: usize) -> f64 {
        self.numbers.get(self.first + index * self.step)
    }

    /// Whether the samples are those of `other`, bit by bit.
    pub fn has_samples_of(&self, other: &Column<'_>) -> bool {
        let bits = |column: &Self, index| column.get(index).to_bits();
        self.n_samples == other.n_samples
            && (0..self.n_samples).all(|index| bits(self, index) == other.get(index).to_bits())
    }
}

/// A variable that only MATLAB reads.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Object {
    /// Where it lies.
    pub path: String,
    /// Its class.
    pub class: String,
}

/// The columns of a file.
#[derive(Debug, Default)]
pub struct Signals<'a> {
    /// Every column, in the order of the file.
    pub columns: Vec<Column<'a>>,
    /// Variables that are objects.
    pub objects: Vec<Object>,
}

impl<'a> Signals<'a> {
    /// Looks at the variables of a file.
    pub(super) fn of(variables: &[Variable<'a>]) -> Self {
        let mut signals = Self::default();
        for variable in variables {
            signals.value(&variable.value, &variable.name, &[]);
        }
        signals
    }

    /// `better` labels come before the path.
    fn value(&mut self, value: &Value<'a>, path: &str, better: &[Label]) {
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
            Value::Object(class) => self.objects.push(Object { path: path.to_owned(), class: class.clone() }),
            Value::Text(_) | Value::Other => {}
        }
    }

    fn numbers(&mut self, numbers: &Numbers<'a>, path: &str, better: &[Label]) {
        let Numbers { n_rows, n_columns, .. } = *numbers;
        let column =
            |labels: Vec<Label>, first, step, n_samples| Column { labels, numbers: *numbers, first, step, n_samples };
        // A single number is a constant, which --fixed is for.
        if numbers.len() < 2 {
            return;
        }
        if n_rows == 1 || n_columns == 1 {
            let mut labels: Vec<Label> = better.iter().cloned().chain([Label::Name(path.to_owned())]).collect();
            labels.dedup();
            self.columns.push(column(labels, 0, 1, numbers.len()));
        } else if n_rows >= n_columns {
            // Samples go along the longer side.
            for index in 0..n_columns.min(MAX_MATRIX_COLUMNS) {
                let labels = vec![Label::Name(format!("{path}(:,{})", index + 1))];
                self.columns.push(column(labels, index * n_rows, 1, n_rows));
            }
        } else {
            for index in 0..n_rows.min(MAX_MATRIX_COLUMNS) {
                let labels = vec![Label::Name(format!("{path}({},:)", index + 1))];
                self.columns.push(column(labels, index, n_rows, n_columns));
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
                    Some(Value::Text(label)) if !label.trim().is_empty() => {
                        vec![Label::Name(label.trim().to_owned())]
                    }
                    _ => Vec::new(),
                };
                if n_signals == 1 {
                    better.push(Label::Name(before_dot.clone()));
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
            self.value(data, &at("Data"), &[Label::Name(before_dot)]);
        } else if let (Some(Value::Text(_)), Some(data @ Value::Numbers(_))) = (field("Name"), field("Data")) {
            let (name, unit) = (text("Name"), text("Unit"));
            let mut better = Vec::new();
            if !name.is_empty() && !unit.is_empty() {
                better.push(Label::WithUnit { name: name.clone(), unit: unit.clone() });
            }
            let is_axis = path.split('(').next().is_some_and(|path| path.ends_with(".X"));
            if !name.is_empty() {
                better.push(Label::Name(name));
            } else if is_axis {
                better.push(Label::Time { unit });
            }
            self.value(data, &at("Data"), &better);
        } else {
            for (name, value) in structure.fields.iter().zip(structure.elements.get(index).into_iter().flatten()) {
                self.value(value, &at(name), &[Label::Name(name.clone())]);
            }
        }
    }
}

/// The label of a time in seconds.
fn seconds() -> Label {
    Label::Time { unit: "s".to_owned() }
}
