//! The muscle's dimensions as a file for a fit.

use pam_virtual_bench::TrueMuscle;

/// The text of the file: millimeters and degrees, to a nanometer and a nanodegree.
pub(crate) fn text(muscle: &TrueMuscle) -> String {
    let dimensions = muscle.muscle();
    let rounded = |value: f64| (value * 1e9).round() / 1e9;
    let entries = [
        ("rest_length_mm", dimensions.rest_length_m * 1e3),
        ("rest_radius_mm", dimensions.rest_radius_m * 1e3),
        ("braid_angle_deg", dimensions.braid_angle_rad.to_degrees()),
        ("wall_thickness_mm", dimensions.wall_thickness_m * 1e3),
        ("strand_count", dimensions.strand_count),
        ("strand_diameter_mm", dimensions.strand_diameter_m * 1e3),
        ("strand_modulus_gpa", muscle.contact_modulus_pa() * 1e-9),
    ];
    let lines: String = entries.into_iter().map(|(key, value)| format!("{key} = {}\n", rounded(value))).collect();
    format!("# Dimensions as measured on the virtual bench.\n{lines}\n# Dimensions that a fit may adjust.\nfit = []\n")
}
