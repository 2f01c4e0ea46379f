//! The word that was probably meant.

/// The candidate nearest to `word`, if one is near enough to be worth suggesting; case does not count.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = word.to_lowercase();
    let mut best: Option<(f64, &str)> = None;
    for candidate in candidates {
        let similarity = strsim::jaro_winkler(&lower, &candidate.to_lowercase());
        // 0.8 keeps transposed, missing and doubled letters and drops words that only share a beginning.
        if similarity > best.map_or(0.8, |(similarity, _)| similarity) {
            best = Some((similarity, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_of_the_finger_finds_its_word() {
        let effects = ["stribeck", "viscous-damping", "mullins-softening"];
        assert_eq!(nearest("Stibreck", effects), Some("stribeck"));
        assert_eq!(nearest("viscous-dampning", effects), Some("viscous-damping"));
        assert_eq!(nearest("gearbox", effects), None);
    }
}
