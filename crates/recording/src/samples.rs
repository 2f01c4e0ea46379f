//! Columns of a recording, in chunks: in memory while they are few, in a temporary file beyond.

use std::io;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use super::spill::Spill;
use super::units::Quantity;

/// Rows in a chunk (the last may have fewer).
pub const CHUNK_ROWS: usize = 16_384;

/// Rows of one recording that stay in memory unless the options say otherwise: 48 MB for four columns.
pub const MEMORY_ROWS: usize = 1_500_000;

/// Most columns that a chunk holds.
pub(crate) const MAX_COLUMNS: usize = 5;

/// Columns of a recording, in SI.
///
/// # Design
/// A bench that logs for hours writes more rows than memory holds, and everything downstream walks over
/// rows once, a chunk at a time. So the first chunks stay in memory and the others go to an unnamed
/// temporary file, from which any thread reads any chunk by position. Mapping the file would need `unsafe`. A clone
/// shares both.
#[derive(Debug, Clone)]
pub struct Samples {
    n_rows: usize,
    layout: Layout,
    sensor_ranges: [Option<[f64; 2]>; MAX_COLUMNS],
    in_memory: Vec<Arc<Vec<f64>>>,
    spilled: Option<Arc<Spill>>,
}

/// Which optional columns there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Layout {
    has_force: bool,
    has_temperature: bool,
}

impl Layout {
    fn n_columns(self) -> usize {
        3 + usize::from(self.has_force) + usize::from(self.has_temperature)
    }
}

impl Samples {
    /// Samples from columns of equal length, held in memory; no temperature.
    ///
    /// # Panics
    /// Where the columns differ in length.
    pub fn from_columns(time_s: &[f64], pressure_pa: &[f64], length_m: &[f64], force_n: &[f64]) -> Self {
        assert!(
            [pressure_pa, length_m, force_n].iter().all(|column| column.len() == time_s.len()),
            "columns of a recording have one length"
        );
        let mut builder = SamplesBuilder::new(true, false, usize::MAX);
        let written = builder.extend([time_s, pressure_pa, length_m, force_n, &[]]);
        debug_assert!(written.is_ok(), "nothing is written to a file");
        builder.finish_in_memory()
    }

    /// Rows in the recording.
    pub fn n_rows(&self) -> usize {
        self.n_rows
    }

    /// Chunks in the recording.
    pub fn n_chunks(&self) -> usize {
        self.n_rows.div_ceil(CHUNK_ROWS)
    }

    /// Whether force was recorded.
    pub fn has_force(&self) -> bool {
        self.layout.has_force
    }

    /// Ends of the range of the sensor of `quantity`, in SI, where they were told.
    pub fn sensor_range(&self, quantity: Quantity) -> Option<[f64; 2]> {
        self.sensor_ranges[quantity as usize]
    }

    /// The same samples of sensors with these ranges, in the order of [`Quantity::ALL`].
    pub(crate) fn with_sensor_ranges(self, sensor_ranges: [Option<[f64; 2]>; MAX_COLUMNS]) -> Self {
        Self { sensor_ranges, ..self }
    }

    /// Whether temperature was recorded.
    pub fn has_temperature(&self) -> bool {
        self.layout.has_temperature
    }

    /// Rows of chunk `index`.
    pub fn chunk_rows(&self, index: usize) -> Range<usize> {
        let first = index * CHUNK_ROWS;
        first..(first + CHUNK_ROWS).min(self.n_rows)
    }

    /// Chunk `index`; any number of threads may ask at once. Chunks in memory are shared, not copied.
    ///
    /// # Errors
    /// Where the temporary file cannot be read.
    ///
    /// # Panics
    /// Where there is no such chunk.
    pub fn chunk(&self, index: usize) -> io::Result<Chunk> {
        let rows = self.chunk_rows(index);
        let data = match (self.in_memory.get(index), &self.spilled) {
            (Some(data), _) => Arc::clone(data),
            (None, Some(spilled)) if index < self.n_chunks() => {
                Arc::new(spilled.read(index - self.in_memory.len(), rows.len() * self.layout.n_columns())?)
            }
            _ => panic!("chunk {index} of {}", self.n_chunks()),
        };
        Ok(Chunk { data, layout: self.layout, first_row: rows.start, n_rows: rows.len() })
    }

    /// Rows `rows` alone, from the first chunk on; as many stay in memory as of a recording that is read.
    ///
    /// # Errors
    /// Where a temporary file cannot be read or written.
    pub fn slice(&self, rows: Range<usize>) -> io::Result<Self> {
        let mut builder = SamplesBuilder::new(self.layout.has_force, self.layout.has_temperature, MEMORY_ROWS);
        for of_chunk in self.parts(rows) {
            let (chunk, here) = of_chunk?;
            let part = |column: &'_ [f64]| column.get(here.clone()).map(<[f64]>::to_vec).unwrap_or_default();
            let columns =
                [chunk.time_s(), chunk.pressure_pa(), chunk.length_m(), chunk.force_n(), chunk.temperature_k()]
                    .map(part);
            builder.extend(std::array::from_fn(|column| columns[column].as_slice())).map_err(|failed| failed.source)?;
        }
        let sliced = builder.finish().map_err(|failed| failed.source)?;
        Ok(sliced.with_sensor_ranges(self.sensor_ranges))
    }

    /// Every chunk that has some of `rows` in turn, and which of its own rows those are.
    pub fn parts(&self, rows: Range<usize>) -> impl Iterator<Item = io::Result<(Chunk, Range<usize>)>> + '_ {
        (rows.start / CHUNK_ROWS..rows.end.div_ceil(CHUNK_ROWS)).map(move |index| {
            let chunk = self.chunk(index)?;
            let (first, n) = (chunk.first_row, chunk.n_rows);
            Ok((chunk, rows.start.max(first) - first..rows.end.min(first + n) - first))
        })
    }

    /// Every chunk in turn.
    pub fn chunks(&self) -> impl Iterator<Item = io::Result<Chunk>> + '_ {
        (0..self.n_chunks()).map(|index| self.chunk(index))
    }
}

/// Consecutive rows of a recording, column by column.
#[derive(Debug, Clone)]
pub struct Chunk {
    data: Arc<Vec<f64>>,
    layout: Layout,
    first_row: usize,
    n_rows: usize,
}

impl Chunk {
    /// Index in the recording of the first row.
    pub fn first_row(&self) -> usize {
        self.first_row
    }

    /// Rows in the chunk.
    pub fn n_rows(&self) -> usize {
        self.n_rows
    }

    /// Rows in the recording that the chunk covers.
    pub fn rows(&self) -> Range<usize> {
        self.first_row..self.first_row + self.n_rows
    }

    /// Time, in s.
    pub fn time_s(&self) -> &[f64] {
        self.column(0)
    }

    /// Gauge pressure, in Pa.
    pub fn pressure_pa(&self) -> &[f64] {
        self.column(1)
    }

    /// Length, clamp to clamp, in m.
    pub fn length_m(&self) -> &[f64] {
        self.column(2)
    }

    /// Tension, in N; empty where force was not recorded.
    pub fn force_n(&self) -> &[f64] {
        if self.layout.has_force { self.column(3) } else { &[] }
    }

    /// Temperature, in K; empty where it was not recorded.
    pub fn temperature_k(&self) -> &[f64] {
        if self.layout.has_temperature { self.column(self.layout.n_columns() - 1) } else { &[] }
    }

    fn column(&self, index: usize) -> &[f64] {
        &self.data[index * self.n_rows..(index + 1) * self.n_rows]
    }
}

/// Why a chunk could not be put away.
#[derive(Debug)]
pub(crate) struct SpillFailed {
    pub(crate) directory: PathBuf,
    pub(crate) source: io::Error,
}

/// Collects rows into chunks.
#[derive(Debug)]
pub(crate) struct SamplesBuilder {
    samples: Samples,
    memory_rows: usize,
    directory: PathBuf,
    /// The chunk that is being filled, column by column, each as long as a whole one; empty before its first row.
    open: Vec<f64>,
    open_rows: usize,
}

impl SamplesBuilder {
    /// Keeps `memory_rows` rows in memory, rounded up to whole chunks.
    pub(crate) fn new(has_force: bool, has_temperature: bool, memory_rows: usize) -> Self {
        Self {
            samples: Samples {
                n_rows: 0,
                layout: Layout { has_force, has_temperature },
                sensor_ranges: [None; MAX_COLUMNS],
                in_memory: Vec::new(),
                spilled: None,
            },
            memory_rows,
            directory: std::env::temp_dir(),
            open: Vec::new(),
            open_rows: 0,
        }
    }

    /// Rows taken so far.
    pub(crate) fn n_rows(&self) -> usize {
        self.samples.n_rows
    }

    /// Appends rows: time, pressure, length, force, temperature; the last two are left out where there are none.
    pub(crate) fn extend(&mut self, columns: [&[f64]; MAX_COLUMNS]) -> Result<(), SpillFailed> {
        let n_rows = columns[0].len();
        let mut done = 0;
        while done < n_rows {
            let take = (CHUNK_ROWS - self.open_rows).min(n_rows - done);
            if self.open.is_empty() {
                self.open = vec![0.0; CHUNK_ROWS * self.samples.layout.n_columns()];
            }
            let present = columns.iter().filter(|column| !column.is_empty());
            for (open, column) in self.open.chunks_exact_mut(CHUNK_ROWS).zip(present) {
                open[self.open_rows..][..take].copy_from_slice(&column[done..done + take]);
            }
            done += take;
            self.open_rows += take;
            self.samples.n_rows += take;
            if self.open_rows == CHUNK_ROWS {
                self.close_chunk()?;
            }
        }
        Ok(())
    }

    /// The samples.
    pub(crate) fn finish(mut self) -> Result<Samples, SpillFailed> {
        if self.open_rows > 0 {
            self.close_chunk()?;
        }
        Ok(self.samples)
    }

    fn finish_in_memory(mut self) -> Samples {
        if self.open_rows > 0 {
            let data = self.take_open();
            self.samples.in_memory.push(data);
        }
        self.samples
    }

    fn close_chunk(&mut self) -> Result<(), SpillFailed> {
        let data = self.take_open();
        let samples = &mut self.samples;
        if samples.spilled.is_none() && samples.in_memory.len() * CHUNK_ROWS < self.memory_rows {
            samples.in_memory.push(data);
            return Ok(());
        }
        let failed = |source| SpillFailed { directory: self.directory.clone(), source };
        if samples.spilled.is_none() {
            let chunk_len = CHUNK_ROWS * samples.layout.n_columns();
            samples.spilled = Some(Arc::new(Spill::create(&self.directory, chunk_len).map_err(failed)?));
        }
        // Nobody shares the file before it is complete.
        match samples.spilled.as_mut().and_then(Arc::get_mut) {
            Some(spilled) => spilled.append(&data).map_err(failed),
            None => Ok(()),
        }
    }

    fn take_open(&mut self) -> Arc<Vec<f64>> {
        let (mut data, rows) = (std::mem::take(&mut self.open), std::mem::take(&mut self.open_rows));
        for column in 1..self.samples.layout.n_columns() {
            data.copy_within(column * CHUNK_ROWS..column * CHUNK_ROWS + rows, column * rows);
        }
        data.truncate(rows * self.samples.layout.n_columns());
        Arc::new(data)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(n_rows: usize) -> [Vec<f64>; 5] {
        std::array::from_fn(|column| (0..n_rows).map(|row| (row * 10 + column) as f64).collect())
    }

    fn build(n_rows: usize, memory_rows: usize, has_force: bool, has_temperature: bool) -> Samples {
        let all = columns(n_rows);
        let mut builder = SamplesBuilder::new(has_force, has_temperature, memory_rows);
        // Uneven pieces, so that chunk borders fall inside them.
        let mut row = 0;
        while row < n_rows {
            let end = (row + 7_001).min(n_rows);
            let piece = |column: usize| &all[column][row..end];
            let force: &[f64] = if has_force { piece(3) } else { &[] };
            let temperature: &[f64] = if has_temperature { piece(4) } else { &[] };
            builder.extend([piece(0), piece(1), piece(2), force, temperature]).unwrap();
            row = end;
        }
        builder.finish().unwrap()
    }

    fn check(samples: &Samples, n_rows: usize) {
        let all = columns(n_rows);
        assert_eq!(samples.n_rows(), n_rows);
        let mut seen = 0;
        for chunk in samples.chunks() {
            let chunk = chunk.unwrap();
            assert_eq!(chunk.first_row(), seen);
            let rows = chunk.rows();
            assert_eq!(chunk.time_s(), &all[0][rows.clone()]);
            assert_eq!(chunk.pressure_pa(), &all[1][rows.clone()]);
            assert_eq!(chunk.length_m(), &all[2][rows.clone()]);
            assert_eq!(chunk.force_n(), if samples.has_force() { &all[3][rows.clone()] } else { &[] });
            assert_eq!(chunk.temperature_k(), if samples.has_temperature() { &all[4][rows] } else { &[] });
            seen += chunk.n_rows();
        }
        assert_eq!(seen, n_rows);
    }

    #[test]
    fn chunks_give_back_what_was_put_in_memory_or_file() {
        for n_rows in [0, 1, CHUNK_ROWS - 1, CHUNK_ROWS, CHUNK_ROWS + 1, 3 * CHUNK_ROWS + 5] {
            for memory_rows in [0, 1, CHUNK_ROWS, 2 * CHUNK_ROWS, usize::MAX] {
                for (force, temperature) in [(true, false), (false, true), (true, true), (false, false)] {
                    check(&build(n_rows, memory_rows, force, temperature), n_rows);
                }
            }
        }
    }

    #[test]
    fn threads_read_a_spilled_recording_at_once() {
        let samples = build(5 * CHUNK_ROWS + 9, CHUNK_ROWS, true, false);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| check(&samples, 5 * CHUNK_ROWS + 9));
            }
        });
    }

    #[test]
    fn a_slice_has_its_rows_from_its_first_chunk_on() {
        let samples = build(3 * CHUNK_ROWS + 5, CHUNK_ROWS, true, false);
        let rows = CHUNK_ROWS - 7..2 * CHUNK_ROWS + 11;
        let slice = samples.slice(rows.clone()).unwrap();
        let times: Vec<f64> = slice.chunks().flat_map(|chunk| chunk.unwrap().time_s().to_vec()).collect();
        assert_eq!(times, rows.clone().map(|row| (row * 10) as f64).collect::<Vec<_>>());
        assert_eq!(slice.chunk(1).unwrap().force_n()[0], ((rows.start + CHUNK_ROWS) * 10 + 3) as f64);
    }

    #[test]
    fn columns_given_directly_stay_in_memory() {
        let [time, pressure, length, force, _] = columns(CHUNK_ROWS + 3);
        check(&Samples::from_columns(&time, &pressure, &length, &force), CHUNK_ROWS + 3);
    }

    #[test]
    fn a_directory_that_takes_no_file_is_named() {
        let mut builder = SamplesBuilder::new(true, false, 0);
        builder.directory = PathBuf::from("/nonexistent/spill");
        let column = vec![1.0; CHUNK_ROWS];
        let failed = builder.extend([&column, &column, &column, &column, &[]]).unwrap_err();
        assert_eq!(failed.directory, PathBuf::from("/nonexistent/spill"));
        assert_eq!(failed.source.kind(), io::ErrorKind::NotFound);
    }
}
