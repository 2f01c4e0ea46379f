//! What was concealed in the cases of a folder.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use super::ask::Layout;
use super::score::Concealed;

pub(super) fn text_of(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), ToOwned::to_owned)
}

pub(super) fn strings(value: &Value) -> Vec<String> {
    value.as_array().map(|values| values.iter().map(text_of).collect()).unwrap_or_default()
}

/// What was concealed in each case of `folder`, at most the `first` of them.
///
/// # Errors
/// Where `truth.json` cannot be read or holds no cases.
pub fn truths(folder: &Path, layout: Layout, first: Option<usize>) -> Result<Vec<Concealed>> {
    let path = folder.join("truth.json");
    let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let truth: Value = serde_json::from_str(&text)?;
    let mut concealed = Vec::new();
    match layout {
        Layout::Worlds => {
            for case in truth["cases"].as_array().context("truth.json holds no cases")? {
                let mut world: BTreeMap<String, String> = case["world"]
                    .as_object()
                    .map(|world| {
                        world.iter().filter(|(_, v)| !v.is_array()).map(|(k, v)| (k.clone(), text_of(v))).collect()
                    })
                    .unwrap_or_default();
                let severities: Vec<f64> =
                    case["severity_over_floor"].as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
                if let Some(least) = severities.iter().copied().reduce(f64::min) {
                    let class =
                        ["1.2 to 2.5", "2.5 to 6", "above 6"][usize::from(least > 2.5) + usize::from(least > 6.0)];
                    world.insert("severity".to_owned(), class.to_owned());
                }
                let places = case["place"].as_array().into_iter().flatten().filter_map(|place| {
                    let coordinate = place["coordinate"].as_str()?.to_owned();
                    let recording = place["recording"].as_str().map(ToOwned::to_owned);
                    Some((coordinate, place["from"].as_f64()?, place["to"].as_f64()?, recording))
                });
                concealed.push(Concealed {
                    case: text_of(&case["case"]),
                    kind: text_of(&case["kind"]),
                    ids: strings(&case["concealed"]),
                    places: places.collect(),
                    world,
                    severities,
                });
            }
        }
        Layout::Outside => {
            for (name, case) in truth.as_object().context("truth.json holds no cases")? {
                let ids = strings(&case["concealed"]);
                let kind = match ids.len() {
                    0 => "nothing",
                    1 if ids[0].contains("nameless") => "nameless",
                    1 => "one",
                    _ => "two",
                };
                let world = ["standstill", "rate_hz"].map(|key| (key.to_owned(), text_of(&case[key])));
                concealed.push(Concealed {
                    case: name.clone(),
                    kind: kind.to_owned(),
                    ids,
                    world: world.into_iter().collect(),
                    ..Concealed::default()
                });
            }
        }
    }
    concealed.truncate(first.unwrap_or(usize::MAX));
    ensure!(!concealed.is_empty(), "no cases");
    Ok(concealed)
}
