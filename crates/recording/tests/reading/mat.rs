//! Files of MATLAB, Simulink and dSPACE: by SciPy (`scripts/make-mat-fixtures.py`), and byte by byte in both orders.

use std::io::Write as _;

use insta::assert_snapshot;
use pam_recording::{ReadOptions, Recording};
use proptest::prelude::*;

use super::{options, read, refusal, rows};

const VECTORS: &[u8] = include_bytes!("data/vectors.mat");
const SIMULINK: &[u8] = include_bytes!("data/simulink.mat");
const DSPACE: &[u8] = include_bytes!("data/dspace.mat");

/// Common content of all three.
fn is_the_lift(recording: &Recording) {
    let rows = rows(recording);
    assert_eq!(rows.len(), 12);
    for (index, row) in rows.iter().enumerate() {
        let index = index as f64;
        let expected = [0.01 * index, (100.0 + 10.0 * index) * 1e3, (260.0 - 0.5 * index) / 1e3, 20.0 + 3.0 * index];
        for (value, expected) in row.iter().zip(expected) {
            // Single precision, in one of the files.
            assert!((value - expected).abs() <= 1e-6 * expected.abs(), "{row:?}");
        }
    }
}

#[test]
fn vectors_are_columns_whatever_their_type_and_shape() {
    let recording = read(VECTORS, &options(["--map pressure_bar=p_meas"])).unwrap();
    is_the_lift(&recording);
    assert!(recording.ignored_columns.is_empty(), "{:?}", recording.ignored_columns);
    assert_eq!(recording.sha256, pam_recording::sha256_hex(VECTORS));
}

#[test]
fn a_structure_with_time_gives_its_labels_and_seconds() {
    let options = options(["--map length_mm=out.signals(2).values(:,1)", "--map force_N=OUT.signals(2).values(:,2)"]);
    is_the_lift(&read(SIMULINK, &options).unwrap());
}

#[test]
fn a_measurement_of_dspace_gives_names_and_units() {
    for time in ["time_s", "rec_001.X.Data"] {
        let mut options = options(["--map length_mm=Model Root/L"]);
        options.map.push(format!("time_s={time}").parse().unwrap());
        is_the_lift(&read(DSPACE, &options).unwrap());
    }
}

#[test]
fn a_name_that_another_variable_has_too_is_found_by_its_path() {
    let file = |name: &str| {
        let field = |scale: f64| array(Endian::Little, "", 6, &[3, 1], 9, &doubles(Endian::Little, &ramp(scale)));
        structure(Endian::Little, name, &[("time_s", field(1.0)), ("p", field(2.0)), ("force_N", field(3.0))])
    };
    let bytes = level_5(Endian::Little, &[file("before"), file("after")]);
    let asked = ["--map time_s=after.time_s", "--map pressure_kPa=after.p", "--map force_N=before.force_N"];
    let mut options = options(asked);
    options.fixed.push("length_mm=200".parse().unwrap());
    assert_eq!(rows(&read(&bytes, &options).unwrap())[2], [2.0, 4e3, 0.2, 6.0]);
}

#[test]
fn what_a_file_lacks_is_asked_for() {
    assert_snapshot!(refusal(VECTORS, &ReadOptions::default()), @"log.csv: no column gives pressure; name a column pressure_kPa in the header, point to one with --map pressure_kPa=COLUMN, or give a constant with --fixed pressure_kPa=VALUE (the file has time_s, p_meas, length_mm, force_N)");
    assert_snapshot!(refusal(DSPACE, &options(["--map length_mm=Model/L"])), @r#"log.csv: --map names column "Model/L", which the file lacks; did you mean "Model Root/L"?"#);
    assert_snapshot!(refusal(SIMULINK, &options(["--map force_N=forze"])), @r#"log.csv: --map names column "forze", which the file lacks; it has time_s, pressure_kPa, out.signals(2).values(:,1), out.signals(2).values(:,2)"#);
    assert_snapshot!(refusal(VECTORS, &options(["--columns time_s,pressure_kPa,length_mm,force_N"])), @"log.csv: the file has a header of its own; leave --columns away and rename its columns with --map");
    let one = |name, n, value: &[f64]| array(Endian::Big, name, 6, &[n, 1], 9, &doubles(Endian::Big, value));
    let file = |arrays: &[Vec<u8>]| level_5(Endian::Big, arrays);
    let time = one("time_s", 3, &ramp(1.0));
    assert_snapshot!(refusal(file(&[time.clone(), one("pressure", 3, &ramp(1.0))]), &ReadOptions::default()), @r#"log.csv: column "pressure" has no unit; add it to the name (kPa, Pa, MPa, bar or psi) or give it on the command line, for example --map pressure_kPa=pressure"#);
    let short = file(&[time.clone(), one("pressure_kPa", 2, &ramp(1.0)[..2])]);
    let rest = options(["--fixed length_mm=200", "--fixed force_N=1"]);
    assert_snapshot!(refusal(short, &rest), @r#"log.csv: "time_s" has 3 samples and "pressure_kPa" 2; save signals of one rate (in MATLAB: interp1), or name others with --map"#);
    assert_snapshot!(refusal(file(&[time.clone(), one("pressure_kPa", 3, &[1.0, f64::NAN, 2.0])]), &rest), @r#"log.csv:2:2: "NaN" in column "pressure_kPa" is not finite; correct the row, or drop such rows with --skip-bad-rows"#);
    assert_snapshot!(refusal(file(&[time, object("p")]), &ReadOptions::default()), @r#"log.csv: variable "p" is a timeseries object, which only MATLAB reads; save its numbers, for a timeseries: t = p.Time; x = p.Data; save('log.mat', 't', 'x', '-v7')"#);
    assert_snapshot!(refusal(file(&[]), &ReadOptions::default()), @"log.csv: no column gives time; name a column time_s in the header or point to one with --map time_s=COLUMN (the file has no named column)");
}

#[test]
fn other_formats_are_named_with_the_way_out() {
    let level_4 = [[0_u32, 3, 1, 0, 2].map(u32::to_le_bytes).concat(), b"p\0".to_vec(), vec![0; 24]].concat();
    assert_snapshot!(refusal(level_4, &ReadOptions::default()), @"log.csv: this is a MATLAB file of version 4, which is not read; load it in MATLAB and save it with save -v7");
    let mut hdf5 = level_5(Endian::Little, &[]);
    hdf5[125] = 2;
    hdf5.resize(512, 0);
    hdf5.extend(b"\x89HDF\r\n\x1a\n");
    assert_snapshot!(refusal(hdf5, &ReadOptions::default()), @r#"log.csv: this is a MATLAB file of version 7.3 (HDF5), which is not read; save it with save -v7, or write it as CSV: python3 -c 'import h5py, pandas, sys; d = {}; h5py.File(sys.argv[1]).visititems(lambda n, o: d.update({n: pandas.Series(o[()].ravel())}) if isinstance(o, h5py.Dataset) and o.dtype.kind in "fiu" and o.size == max(o.shape or [0]) else None); pandas.DataFrame(d).to_csv(sys.argv[2], index=False)' log.h5 log.csv"#);
    assert_snapshot!(refusal(b"\x89HDF\r\n\x1a\n", &ReadOptions::default()), @r#"log.csv: this is an HDF5 file, which is not read; write it as CSV: python3 -c 'import h5py, pandas, sys; d = {}; h5py.File(sys.argv[1]).visititems(lambda n, o: d.update({n: pandas.Series(o[()].ravel())}) if isinstance(o, h5py.Dataset) and o.dtype.kind in "fiu" and o.size == max(o.shape or [0]) else None); pandas.DataFrame(d).to_csv(sys.argv[2], index=False)' log.h5 log.csv"#);
    assert_snapshot!(refusal(b"PAR1\x15\x04\x15\0", &ReadOptions::default()), @"log.csv: this is a Parquet file, which is not read; write it as CSV: python3 -c 'import pandas, sys; pandas.read_parquet(sys.argv[1]).to_csv(sys.argv[2], index=False)' log.parquet log.csv");
}

#[test]
fn a_damaged_file_is_refused() {
    assert_snapshot!(refusal(&SIMULINK[..SIMULINK.len() - 40], &ReadOptions::default()), @"log.csv: the MATLAB file is damaged or cut off (it ends within an element); copy it anew, or save it anew with save -v7");
    let mut wrong = SIMULINK.to_vec();
    wrong[140] ^= 0xff;
    assert_snapshot!(refusal(wrong, &ReadOptions::default()), @"log.csv: the MATLAB file is damaged or cut off (a compressed variable cannot be decompressed); copy it anew, or save it anew with save -v7");
    let missing = array(Endian::Little, "p", 6, &[1 << 31, 1 << 31, 1 << 31], 9, &[]);
    assert_snapshot!(refusal(level_5(Endian::Little, &[missing]), &ReadOptions::default()), @"log.csv: the MATLAB file is damaged or cut off (an array is larger than any memory); copy it anew, or save it anew with save -v7");
    let too_few = array(Endian::Little, "p", 6, &[4, 1], 9, &doubles(Endian::Little, &ramp(1.0)));
    assert_snapshot!(refusal(level_5(Endian::Little, &[too_few]), &ReadOptions::default()), @"log.csv: the MATLAB file is damaged or cut off (an array has not as many numbers as its dimensions say); copy it anew, or save it anew with save -v7");
}

#[test]
fn structures_beyond_any_depth_and_without_fields_do_no_harm() {
    let mut deep = array(Endian::Little, "", 6, &[3, 1], 9, &doubles(Endian::Little, &ramp(1.0)));
    for _ in 0..5000 {
        deep = structure(Endian::Little, "s", &[("s", deep)]);
    }
    assert_snapshot!(refusal(level_5(Endian::Little, &[deep]), &ReadOptions::default()), @"log.csv: the MATLAB file is damaged or cut off (its structures are too deep); copy it anew, or save it anew with save -v7");
    let many = parts(
        Endian::Little,
        "s",
        2,
        &[u32::MAX >> 2, 2],
        &[element(Endian::Little, 5, &[0; 4]), element(Endian::Little, 1, &[])],
    );
    assert!(refusal(level_5(Endian::Little, &[many]), &ReadOptions::default()).contains("no column gives time"));
}

#[test]
fn a_compressed_bomb_is_refused_before_it_fills_the_memory() {
    let mut zeros = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    for _ in 0..600 {
        zeros.write_all(&[0; 1 << 20]).unwrap();
    }
    let bomb = zeros.finish().unwrap();
    assert!(bomb.len() < 1 << 20);
    let bytes = level_5(Endian::Little, &[element(Endian::Little, 15, &bomb)]);
    let message = refusal(bytes, &ReadOptions::default());
    assert!(message.contains("grows beyond"), "{message}");
}

#[test]
fn both_orders_of_bytes_and_every_type_of_number_are_read() {
    for endian in [Endian::Little, Endian::Big] {
        let ordered = |bytes: Vec<Vec<u8>>| -> Vec<u8> {
            let turned = |mut low_first: Vec<u8>| {
                if endian == Endian::Big {
                    low_first.reverse();
                }
                low_first
            };
            bytes.into_iter().flat_map(turned).collect()
        };
        let values = [0_i8, 3, 7];
        let types: [(u32, Vec<u8>); 10] = [
            (1, ordered(values.map(|v| v.to_le_bytes().to_vec()).to_vec())),
            (2, ordered(values.map(|v| (v as u8).to_le_bytes().to_vec()).to_vec())),
            (3, ordered(values.map(|v| i16::from(v).to_le_bytes().to_vec()).to_vec())),
            (4, ordered(values.map(|v| (v as u16).to_le_bytes().to_vec()).to_vec())),
            (5, ordered(values.map(|v| i32::from(v).to_le_bytes().to_vec()).to_vec())),
            (6, ordered(values.map(|v| (v as u32).to_le_bytes().to_vec()).to_vec())),
            (7, ordered(values.map(|v| f32::from(v).to_le_bytes().to_vec()).to_vec())),
            (9, ordered(values.map(|v| f64::from(v).to_le_bytes().to_vec()).to_vec())),
            (12, ordered(values.map(|v| i64::from(v).to_le_bytes().to_vec()).to_vec())),
            (13, ordered(values.map(|v| (v as u64).to_le_bytes().to_vec()).to_vec())),
        ];
        for (kind, bytes) in types {
            let time = array(endian, "time_s", 6, &[1, 3], 9, &doubles(endian, &ramp(1.0)));
            let force = array(endian, "force_N", 6, &[3, 1], kind, &bytes);
            let file = level_5(endian, &[time, force]);
            let recording = read(file, &options(["--fixed length_mm=200", "--fixed pressure_kPa=1"])).unwrap();
            let forces: Vec<f64> = rows(&recording).into_iter().map(|row| row[3]).collect();
            assert_eq!(forces, [0.0, 3.0, 7.0], "{endian:?}, type {kind}");
        }
    }
}

#[test]
fn samples_go_along_the_longer_side_of_a_matrix() {
    // Three samples of two channels, channel by channel and sample by sample.
    let values = doubles(Endian::Little, &[0.0, 1.0, 2.0, 5.0, 6.0, 8.0]);
    let tall = level_5(Endian::Little, &[array(Endian::Little, "d", 6, &[3, 2], 9, &values)]);
    let rest = ["--fixed length_mm=200", "--fixed pressure_kPa=1"];
    let of = |bytes: &[u8], time: &str, force: &str| {
        let mut options = options(rest);
        options.map = vec![time.parse().unwrap(), force.parse().unwrap()];
        rows(&read(bytes, &options).unwrap()).into_iter().map(|row| [row[0], row[3]]).collect::<Vec<_>>()
    };
    assert_eq!(of(&tall, "time_s=d(:,1)", "force_N=d(:,2)"), [[0.0, 5.0], [1.0, 6.0], [2.0, 8.0]]);
    let values = doubles(Endian::Little, &[0.0, 5.0, 1.0, 6.0, 2.0, 8.0]);
    let wide = level_5(Endian::Little, &[array(Endian::Little, "d", 6, &[2, 3], 9, &values)]);
    assert_eq!(of(&wide, "time_s=d(1,:)", "force_N=d(2,:)"), [[0.0, 5.0], [1.0, 6.0], [2.0, 8.0]]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn broken_files_get_an_answer(
        which in 0_usize..3,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut bytes = [VECTORS, SIMULINK, DSPACE][which].to_vec();
        for (index, byte) in changes {
            let index = 128 + index.index(bytes.len() - 128);
            bytes[index] = byte;
        }
        if let Some(cut) = cut {
            bytes.truncate(128 + cut.index(bytes.len() - 128));
        }
        answers(&bytes);
    }

    #[test]
    fn any_bytes_below_a_header_get_an_answer(
        big in any::<bool>(),
        words in prop::collection::vec(prop_oneof![0_u32..20, any::<u32>()], 0..60),
        compressed in any::<bool>(),
    ) {
        let endian = if big { Endian::Big } else { Endian::Little };
        let words: Vec<u8> = words.into_iter().flat_map(|word| endian.word(word)).collect();
        let body = if compressed { element(endian, 15, &zlib(&words)) } else { words };
        answers(&level_5(endian, &[body]));
    }
}

/// A recording or one line.
fn answers(bytes: &[u8]) {
    for options in [ReadOptions::default(), options(["--skip-bad-rows", "--map pressure_bar=p_meas"])] {
        if let Err(error) = read(bytes, &options) {
            let message = error.to_string();
            assert!(message.starts_with("log.csv:") && message.len() < 2000, "{message:?}");
            assert!(!message.contains(char::is_control), "{message:?}");
        }
    }
}

/// Order of bytes of a file that is written.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Endian {
    Little,
    Big,
}

impl Endian {
    fn word(self, word: u32) -> [u8; 4] {
        if self == Self::Big { word.to_be_bytes() } else { word.to_le_bytes() }
    }
}

fn ramp(scale: f64) -> [f64; 3] {
    [0.0, scale, 2.0 * scale]
}

fn doubles(endian: Endian, values: &[f64]) -> Vec<u8> {
    let bytes = |value: &f64| if endian == Endian::Big { value.to_be_bytes() } else { value.to_le_bytes() };
    values.iter().flat_map(bytes).collect()
}

fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

/// A file of these elements.
fn level_5(endian: Endian, elements: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = vec![b' '; 124];
    bytes.extend(if endian == Endian::Big { b"\x01\0MI" } else { b"\0\x01IM" });
    bytes.extend(elements.concat());
    bytes
}

fn element(endian: Endian, kind: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = [endian.word(kind), endian.word(data.len() as u32)].concat();
    bytes.extend(data);
    if kind != 15 {
        bytes.resize(bytes.len().next_multiple_of(8), 0);
    }
    bytes
}

/// An array of numbers of class `class` that are stored as `kind`.
fn array(endian: Endian, name: &str, class: u32, dimensions: &[u32], kind: u32, numbers: &[u8]) -> Vec<u8> {
    parts(endian, name, class, dimensions, &[element(endian, kind, numbers)])
}

fn parts(endian: Endian, name: &str, class: u32, dimensions: &[u32], rest: &[Vec<u8>]) -> Vec<u8> {
    let flags = [endian.word(class), endian.word(0)].concat();
    let lengths: Vec<u8> = dimensions.iter().flat_map(|length| endian.word(*length)).collect();
    let head = [element(endian, 6, &flags), element(endian, 5, &lengths), element(endian, 1, name.as_bytes())];
    element(endian, 14, &[head.concat(), rest.concat()].concat())
}

/// A structure of one element.
fn structure(endian: Endian, name: &str, fields: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut names = Vec::new();
    for (field, _) in fields {
        names.extend(field.as_bytes());
        names.resize(names.len().next_multiple_of(16), 0);
    }
    let mut rest = vec![element(endian, 5, &endian.word(16)), element(endian, 1, &names)];
    rest.extend(fields.iter().map(|(_, value)| value.clone()));
    parts(endian, name, 2, &[1, 1], &rest)
}

/// A timeseries, as MATLAB writes it.
fn object(name: &str) -> Vec<u8> {
    let flags = [Endian::Big.word(17), Endian::Big.word(0)].concat();
    let words = [name, "MCOS", "timeseries"].map(|word| element(Endian::Big, 1, word.as_bytes()));
    let reference = array(Endian::Big, "", 13, &[1, 1], 6, &[0, 0, 0, 1]);
    element(Endian::Big, 14, &[element(Endian::Big, 6, &flags), words.concat(), reference].concat())
}
