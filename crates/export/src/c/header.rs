//! The header: constants of one model above the parts that it needs.

use std::fmt::Write as _;
use std::path::Path;

use pam_artifact::ModelArtifact;
use pam_inverse_model::InverseNetwork;
use pam_muscle::effects::{AugmentedModel, Role, Term};

use super::constants::{defines, of_direction, of_effects, of_eq11};
use super::inverse;
use super::parts::{EQ11, MOMENT, OBSERVER, Part, Shared};
use super::sentence;
use crate::ExportError;

/// What a header is made of.
#[derive(Debug)]
pub struct Header<'a> {
    /// Model that was identified, for the thresholds of its direction.
    pub artifact: &'a ModelArtifact,
    /// The same with the effects that are to be exported, without events.
    pub model: &'a AugmentedModel,
    /// Its inverse, where there is one.
    pub inverse: Option<&'a InverseNetwork>,
    /// What it was written from, a line each.
    pub origin: &'a [String],
}

/// Names of a header: `muscle_` and `MUSCLE_` for `muscle.h`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Names {
    small: String,
    large: String,
}

impl Names {
    /// Those of a file.
    pub(super) fn of(path: &Path) -> Result<Self, ExportError> {
        let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let stem = if path.as_os_str() == "-" { "muscle".to_owned() } else { stem };
        if !stem.starts_with(|first: char| first.is_ascii_alphabetic()) {
            return Err(ExportError::NoName { name: stem });
        }
        let letter = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
        let name: String = stem.chars().map(letter).collect();
        Ok(Self { small: format!("{}_", name.to_lowercase()), large: format!("{}_", name.to_uppercase()) })
    }

    /// `text` under these names.
    pub(super) fn put_into(&self, text: &str) -> String {
        text.replace("PAM_", &self.large).replace("pam_", &self.small)
    }
}

/// What the names in a file begin with: `muscle_` for `muscle.h`.
///
/// # Errors
/// [`ExportError::NoName`] where the file's name gives none.
pub fn prefix(path: &Path) -> Result<String, ExportError> {
    Ok(Names::of(path)?.small)
}

/// The header for a file at `path`; `-` is `muscle.h`.
///
/// # Errors
/// [`ExportError::NoName`] where the file's name gives none for C, [`ExportError::UnknownEffect`] where an effect has no part.
pub fn header(path: &Path, content: &Header<'_>) -> Result<String, ExportError> {
    let names = Names::of(path)?;
    let parts = parts_of(content.model)?;
    let mut text = "#ifndef PAM_H\n#define PAM_H\n\n#include <math.h>\n\n".to_owned();
    text.push_str("/* Eq. 11, in SI: parameters, and what follows from them and the muscle. */\n");
    text.push_str(&defines(&of_eq11(content.model.base())));
    if !parts.is_empty() {
        text.push_str("\n/* Parameters of the effects, in SI. */\n");
        text.push_str(&defines(&of_effects(&parts)));
    }
    text.push_str("\n/* Thresholds of the direction of motion. */\n");
    text.push_str(&defines(&of_direction(content.artifact, content.model.base())));
    for section in [MOMENT, EQ11] {
        text.push('\n');
        text.push_str(section);
    }
    for shared in Shared::ALL {
        if parts.iter().any(|(part, _)| part.needs(shared)) {
            text.push('\n');
            text.push_str(shared.text());
        }
    }
    for (part, term) in &parts {
        let page = term.effect.page();
        let sentence = term.effect.sentence_at(&term.shape).map(|sentence| sentence.equation());
        let equation = in_comment(sentence.as_deref().unwrap_or(page.equation));
        let _ = writeln!(text, "\n/* {}: {equation} */\n{}", page.name, part.text.trim_end());
    }
    text.push('\n');
    text.push_str(&state(&parts));
    text.push_str(&step(&parts));
    text.push_str(&settled(&parts));
    text.push('\n');
    text.push_str(OBSERVER);
    if let Some(network) = content.inverse {
        text.push_str("\n/* Inverse: scaling, domain, layers. */\n");
        text.push_str(&inverse::part(network));
    }
    text.push_str("\n#endif\n");
    Ok(format!("{}{}", about(content, &names), names.put_into(&text)))
}

/// The effects that are forces, in the order of the model, each with its part.
fn parts_of(model: &AugmentedModel) -> Result<Vec<(Part, &Term)>, ExportError> {
    let forces = model.terms().iter().filter(|term| term.effect.role() != Role::Shift);
    let mut n_empirical = 0;
    let mut part_of = |term: &Term| -> Result<Part, ExportError> {
        if let Some(sentence) = term.effect.sentence_at(&term.shape) {
            n_empirical += 1;
            return Ok(sentence::part(n_empirical, &sentence, term.effect.amplitudes()));
        }
        let id = term.effect.page().id;
        Part::of(id).ok_or_else(|| ExportError::UnknownEffect { id: id.to_owned() })
    };
    forces.map(|term| Ok((part_of(term)?, term))).collect()
}

/// What stands at the top of the file.
fn about(content: &Header<'_>, names: &Names) -> String {
    let mut text = String::from("/* Force of a pneumatic muscle in C99: no allocation, no dependency but math.h.\n\n");
    for line in content.origin {
        let _ = writeln!(text, "   {}", in_comment(line));
    }
    let usage = "
   Every control period, with the gauge pressure and the length as measured:

       static pam_observer observer;   all zeros: a muscle that has not moved yet
       static pam_state state;
       pam_moment now = pam_observe(&observer, 1e-3, pressure_pa, length_m);
       now.force_n = pam_own_force_n(&state, &now);   or as a load cell measures it
       force_n = pam_step(&state, &now);

   pam_step agrees with pam-predict to rounding where it is handed the same instant. pam_observe makes instants without the
   future, which pam-predict knows; see there. pam_settled_force_n is the force of a muscle that has long been where it is.
";
    text.push_str(&names.put_into(usage));
    if content.inverse.is_some() {
        text.push_str(&names.put_into("   pam_inverse gives the pressure for a force, a length and a direction.\n"));
    }
    if content.model.delays_s() != [0.0; 2] {
        let [pressure_s, length_s] = content.model.delays_s();
        let _ = writeln!(
            text,
            "\n   The channels of the recordings were late behind the force: the pressure by {:.1} ms, the length by {:.1} ms. A\n   \
             step takes pressure and length of one instant, so hand it channels that are moved by as much.",
            pressure_s * 1e3,
            length_s * 1e3
        );
    }
    text.push_str("*/\n");
    text
}

/// Text that does not end a comment.
fn in_comment(text: &str) -> String {
    text.replace("*/", "* /").replace("/*", "/ *")
}

fn state(parts: &[(Part, &Term)]) -> String {
    let mut text = "/* What the muscle remembers; all zeros before its first instant, which finds it settled. */\ntypedef struct {\n    \
                    double force_n; /* at the last step */\n    int stepped;\n"
        .to_owned();
    for (part, _) in parts.iter().filter(|(part, _)| part.has_memory()) {
        let name = part.name();
        let _ = writeln!(text, "    pam_{name} {name};");
    }
    text.push_str(
        "} pam_state;\n\n/* Forgets everything. */\nstatic inline void pam_start(pam_state *state)\n{\n    \
         const pam_state fresh = {0};\n    *state = fresh;\n}\n\n",
    );
    text
}

fn step(parts: &[(Part, &Term)]) -> String {
    let calls = |role: Role| -> String {
        let of_role = parts.iter().filter(|(_, term)| term.effect.role() == role);
        of_role.map(|(part, _)| part.call(role)).collect()
    };
    let slope = |shared: Shared, name: &str| {
        let is_needed = parts.iter().any(|(part, _)| part.needs(shared));
        if is_needed {
            format!("    base.{name} = pam_{name}(now.pressure_pa, now.length_m);\n")
        } else {
            String::new()
        }
    };
    let slopes = slope(Shared::Slopes, "slope_n_per_pa") + &slope(Shared::LengthSlope, "slope_n_per_m");
    format!(
        "/* Force, in N, at the next instant. */\n\
         static inline double pam_step(pam_state *state, const pam_moment *moment)\n{{\n    \
         pam_moment now = *moment;\n    double slide, force_n;\n    pam_base base;\n\
         {}    slide = now.direction;\n{}    base = pam_base_at(now.pressure_pa, now.length_m);\n{slopes}    \
         force_n = base.static_force_n - slide * base.friction_n;\n{}{}    \
         state->force_n = force_n;\n    state->stepped = 1;\n    return force_n;\n}}\n\n",
        calls(Role::Sees),
        calls(Role::Slides),
        calls(Role::Pulls),
        calls(Role::Reads),
    )
}

const SETTLED: &str = "\
static inline double pam_settled_at(double pressure_pa, double length_m, double direction, double force_n)
{
    pam_state state;
    pam_moment now = {0};
    pam_start(&state);
    now.pressure_pa = pressure_pa;
    now.length_m = length_m;
    now.contraction_ratio = (PAM_REST_LENGTH_M - length_m) / PAM_REST_LENGTH_M;
    now.direction = direction;
    now.came = 1.0;
    now.slide_m = PAM_REST_LENGTH_M - length_m;
    now.force_n = force_n;
    return pam_step(&state, &now);
}

/* Force, in N, where the muscle has long been and where it came slowly in `direction`. */
static inline double pam_settled_force_n(double pressure_pa, double length_m, double direction)
{
";

/// What the muscle sees may depend on the force: a secant towards the force that results in itself.
const SECANT: &str = "    \
    double before_n = 0.0, excess_before_n = pam_settled_at(pressure_pa, length_m, direction, 0.0);
    double force_n = excess_before_n;
    int i;
    for (i = 0; i < 50; i++) {
        const double excess_n = pam_settled_at(pressure_pa, length_m, direction, force_n) - force_n;
        const double slope = (excess_n - excess_before_n) / (force_n - before_n);
        if (fabs(excess_n) <= 1e-12 * fabs(force_n) || !isfinite(slope) || slope == 0.0) {
            return force_n + excess_n;
        }
        before_n = force_n;
        excess_before_n = excess_n;
        force_n -= excess_n / slope;
    }
    return force_n;
";

const OWN: &str = "
/* What effects see of the force where none is measured: the force at the last step. */
static inline double pam_own_force_n(const pam_state *state, const pam_moment *now)
{
    return state->stepped ? state->force_n : pam_settled_force_n(now->pressure_pa, now->length_m, now->direction);
}
";

fn settled(parts: &[(Part, &Term)]) -> String {
    let sees = parts.iter().any(|(_, term)| term.effect.role() == Role::Sees);
    let body = if sees { SECANT } else { "    return pam_settled_at(pressure_pa, length_m, direction, 0.0);\n" };
    format!("{SETTLED}{body}}}\n{OWN}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_come_from_the_file() {
        let names = Names::of(Path::new("out/Left-Biceps.h")).unwrap();
        assert_eq!(names.put_into("PAM_K1 pam_step"), "LEFT_BICEPS_K1 left_biceps_step");
        assert_eq!(Names::of(Path::new("-")).unwrap().put_into("pam_step"), "muscle_step");
        assert!(Names::of(Path::new("2nd.h")).is_err());
    }
}
