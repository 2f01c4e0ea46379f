//! Scores as lines and tables.

use std::collections::BTreeMap;
use std::io::Write;

use anyhow::Result;
use serde_json::{Value, json};

use super::ceiling::Ceiling;
use super::discovered::Discoveries;
use super::left_out::Without;
use super::score::{Score, Summary, error_left, summarize};

fn discoveries(scores: &[Score], out: &mut impl Write) -> Result<Discoveries> {
    let found = Discoveries::of(scores);
    writeln!(out, "nothing: nothing discovered            {}", found.nothing_where_nothing)?;
    writeln!(out, "nameless: discovered                   {}", found.discovered)?;
    writeln!(out, "  of these with its driver             {}", found.driver)?;
    writeln!(out, "  of these with its memory             {}", found.memory)?;
    writeln!(out, "nameless: error not above the base's   {}", found.no_harm)?;
    if let Some((median, most)) = found.error_left {
        writeln!(out, "nameless: error left, median / 90 %    {median:.3} / {most:.3}")?;
    }
    if let Some((median, most)) = found.settled_left {
        writeln!(out, "  where the direction is settled       {median:.3} / {most:.3}")?;
    }
    Ok(found)
}

fn left_out(scores: &[Score], out: &mut impl Write) -> Result<Option<Without>> {
    let Some(without) = Without::of(scores) else { return Ok(None) };
    writeln!(out, "left out: no name, not consistent      {}", without.no_name)?;
    writeln!(out, "left out: error ≤ 1.5 of the named one {}", without.as_good)?;
    if let Some(over_named) = without.over_named {
        writeln!(out, "left out: error over named, median     {over_named:.2}")?;
    }
    writeln!(out, "left out: discovered                   {}", without.discovered)?;
    writeln!(out, "  of these with its driver             {}", without.driver)?;
    Ok(Some(without))
}

fn ceilings(scores: &[Score], out: &mut impl Write) -> Result<BTreeMap<&'static str, Ceiling>> {
    let mut ceilings = BTreeMap::new();
    for kind in ["one", "two", "nameless"] {
        let Some(ceiling) = Ceiling::of(scores, kind) else { continue };
        writeln!(out, "{:<38} {:.2}", format!("{kind}: error over trees, median"), ceiling.over_trees)?;
        writeln!(out, "{:<38} {}", format!("{kind}: error ≤ 1.2 of trees"), ceiling.as_good)?;
        if let Some(explained) = ceiling.explained {
            writeln!(out, "{:<38} {explained:.2}", format!("{kind}: explained of explainable"))?;
        }
        ceilings.insert(kind, ceiling);
    }
    Ok(ceilings)
}

fn table(out: &mut impl Write, title: &str, groups: &BTreeMap<String, Summary>) -> Result<()> {
    writeln!(
        out,
        "\n{title:<34} {:>14} {:>14} {:>14} {:>14} {:>14} {:>14}  left 50/90 %",
        "strict", "nothing", "one first", "one only", "or altern.", "nameless"
    )?;
    for (name, sum) in groups {
        let left = sum.error_left.map_or_else(String::new, |(median, most)| format!("{median:.2} / {most:.2}"));
        writeln!(
            out,
            "  {name:<32} {:>14} {:>14} {:>14} {:>14} {:>14} {:>14}  {left}",
            sum.strict, sum.nothing, sum.one_right_first, sum.one_right_only, sum.one_or_alternative, sum.nameless
        )?;
    }
    Ok(())
}

/// Writes every share and every miss, and gives the same as JSON.
///
/// # Errors
/// Where `out` cannot be written.
pub fn report(scores: &[Score], out: &mut impl Write) -> Result<Value> {
    let all: Vec<&Score> = scores.iter().collect();
    let sum = summarize(&all);
    writeln!(out, "nothing: consistent                    {}", sum.nothing)?;
    writeln!(out, "one: right name first                  {}", sum.one_right_first)?;
    writeln!(out, "one: right name and no other           {}", sum.one_right_only)?;
    writeln!(out, "one: name or declared alternative      {}", sum.one_or_alternative)?;
    writeln!(out, "two: both and no other                 {}", sum.both_only)?;
    writeln!(out, "two: both, at most one other           {}", sum.both_and_one_other)?;
    writeln!(out, "nameless: no name, not consistent      {}", sum.nameless)?;
    writeln!(out, "regions that meet a known place        {}", sum.regions)?;
    writeln!(out, "refused                                {}", sum.refused)?;
    writeln!(out, "all, strict                            {}", sum.strict)?;
    writeln!(out, "all, end-taper forgiven on slices      {}", sum.strict_but_ends)?;
    if let Some((median, most)) = sum.error_left {
        writeln!(out, "held-out error left, median / 90 %     {median:.3} / {most:.3}")?;
    }
    let found = discoveries(scores, out)?;
    let without = left_out(scores, out)?;
    let ceilings = ceilings(scores, out)?;
    let mut by_world: BTreeMap<String, BTreeMap<String, Vec<&Score>>> = BTreeMap::new();
    let mut by_effect: BTreeMap<String, Vec<&Score>> = BTreeMap::new();
    for score in scores {
        for (attribute, value) in &score.truth.world {
            by_world.entry(attribute.clone()).or_default().entry(value.clone()).or_default().push(score);
        }
        if score.truth.kind == "one" || score.truth.kind == "nameless" {
            by_effect.entry(score.truth.ids.join(" ")).or_default().push(score);
        }
    }
    let summaries = |groups: &BTreeMap<String, Vec<&Score>>| -> BTreeMap<String, Summary> {
        groups.iter().map(|(name, scores)| (name.clone(), summarize(scores))).collect()
    };
    let mut worlds = BTreeMap::new();
    for (attribute, groups) in &by_world {
        let groups = summaries(groups);
        table(out, attribute, &groups)?;
        worlds.insert(attribute.clone(), groups);
    }
    let effects = summaries(&by_effect);
    table(out, "effect", &effects)?;
    writeln!(
        out,
        "\nmisses: case, concealed (size over floor), verdict, named (alternatives), error left, base error in N"
    )?;
    for score in scores.iter().filter(|score| !score.strict) {
        let named: Vec<String> = score
            .answer
            .named
            .iter()
            .map(|(id, others)| if others.is_empty() { id.clone() } else { format!("{id} ({})", others.join(", ")) })
            .collect();
        let sizes: Vec<String> = score.truth.severities.iter().map(|size| format!("{size:.1}")).collect();
        let truth = if score.truth.ids.is_empty() { "nothing".to_owned() } else { score.truth.ids.join(" + ") };
        writeln!(
            out,
            "  {} {truth} [{}] | {} | {} | {:.2} | {:.2}",
            score.truth.case,
            sizes.join(", "),
            score.answer.refused.as_deref().unwrap_or(&score.answer.verdict),
            named.join("; "),
            error_left(score),
            score.answer.base_n,
        )?;
    }
    Ok(
        json!({ "overall": sum, "discoveries": found, "left_out": without, "ceiling": ceilings, "by_world": worlds, "by_effect": effects, "cases": scores }),
    )
}
