//! Reads the columns of a CSV file into floats with the csv crate and does nothing with them: what the whole of
//! `pam-identify` is compared with.

use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).ok_or("expected the path of a CSV file")?;
    let mut reader = csv::ReaderBuilder::new().from_path(path)?;
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); reader.headers()?.len()];
    let mut record = csv::ByteRecord::new();
    while reader.read_byte_record(&mut record)? {
        for (column, field) in columns.iter_mut().zip(record.iter()) {
            column.push(std::str::from_utf8(field)?.parse()?);
        }
    }
    std::hint::black_box(columns);
    Ok(())
}
