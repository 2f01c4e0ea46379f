//! A mutator that keeps JSON valid: it changes one value, drops, doubles or swaps entries, and leaves the rest alone.
//!
//! Bytes changed at random rarely get past the parser, and what is behind it is what an artifact's reader checks.

use libfuzzer_sys::fuzzer_mutate;
use serde_json::{Map, Number, Value};

/// Numbers at which arithmetic tends to break.
const NUMBERS: [f64; 18] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    2.0,
    1e-3,
    1e3,
    1e6,
    1e9,
    -1e9,
    1e-9,
    1e-300,
    1e150,
    1e300,
    -1e300,
    f64::MAX,
    f64::MIN_POSITIVE,
];

/// Mutates the first `size` bytes of `data`, as `fuzz_mutator!` wants it: three times in four as JSON, else, and where they
/// are no JSON or the result does not fit, as libFuzzer does.
pub fn mutate(data: &mut [u8], size: usize, max_size: usize, seed: u32) -> usize {
    let changed = if seed % 4 == 0 { None } else { change_values(data, size, max_size, seed) };
    changed.unwrap_or_else(|| fuzzer_mutate(data, size, max_size))
}

/// Changes JSON in one to four places; none where the bytes are no JSON or the result does not fit.
fn change_values(data: &mut [u8], size: usize, max_size: usize, seed: u32) -> Option<usize> {
    let mut root: Value = serde_json::from_slice(&data[..size]).ok()?;
    let mut random = Random(u64::from(seed) | 1 << 40);
    for _ in 0..=random.below(4) {
        let nodes = count(&root);
        let wanted = random.below(nodes);
        change(&mut root, &mut { wanted }, &mut random);
    }
    let text = serde_json::to_vec(&root).ok()?;
    (text.len() <= max_size).then(|| {
        data[..text.len()].copy_from_slice(&text);
        text.len()
    })
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n.max(1) as u64) as usize
    }
}

fn count(value: &Value) -> usize {
    1 + match value {
        Value::Array(items) => items.iter().map(count).sum(),
        Value::Object(entries) => entries.values().map(count).sum(),
        _ => 0,
    }
}

/// Changes the value that is `left` steps ahead in reading order.
fn change(value: &mut Value, left: &mut usize, random: &mut Random) -> bool {
    if *left == 0 {
        replace(value, random);
        return true;
    }
    *left -= 1;
    match value {
        Value::Array(items) => items.iter_mut().any(|item| change(item, left, random)),
        Value::Object(entries) => entries.values_mut().any(|entry| change(entry, left, random)),
        _ => false,
    }
}

fn replace(value: &mut Value, random: &mut Random) {
    match value {
        Value::Number(number) => {
            let old = number.as_f64().unwrap_or(0.0);
            let new = match random.below(5) {
                0 => -old,
                1 => old * [0.1, 0.9, 1.1, 2.0, 10.0, 1e3][random.below(6)],
                2 => old + [1.0, -1.0, 1e-3][random.below(3)],
                _ => NUMBERS[random.below(NUMBERS.len())],
            };
            // Counts stay whole, so that they get past the parser.
            *value = if number.is_f64() || new.fract() != 0.0 || new.abs() > 1e18 || new < 0.0 {
                Number::from_f64(new).map_or(Value::Null, Value::Number)
            } else {
                Value::from(new as u64)
            };
        }
        Value::Array(items) if !items.is_empty() => {
            let (first, second) = (random.below(items.len()), random.below(items.len()));
            match random.below(5) {
                0 => drop(items.remove(first)),
                1 => items.push(items[first].clone()),
                2 => items.clear(),
                3 => items.truncate(first),
                _ => items.swap(first, second),
            }
        }
        Value::Object(entries) if !entries.is_empty() => entry(entries, random),
        Value::String(text) => match random.below(3) {
            0 => text.clear(),
            1 => text.push('ß'),
            _ => *text = text.chars().rev().collect(),
        },
        Value::Bool(flag) => *flag = !*flag,
        _ => *value = [Value::Null, Value::from(1.5), Value::Array(Vec::new())][random.below(3)].clone(),
    }
}

/// Drops an entry, or gives it the value of another.
fn entry(entries: &mut Map<String, Value>, random: &mut Random) {
    let keys: Vec<String> = entries.keys().cloned().collect();
    let (first, second) = (&keys[random.below(keys.len())], &keys[random.below(keys.len())]);
    if random.below(3) == 0 {
        entries.remove(first);
    } else {
        let other = entries[second].clone();
        entries.insert(first.clone(), other);
    }
}
