//! Symbols of parameters, as the equations write them: what artifacts call `time_constant_s` is `τ` there.

use super::CATALOGUE;
use crate::force::Parameter;

/// Symbol of parameter `name` of effect `id` of the catalogue in its equation; none where the equation has no single one.
pub fn symbol_of_effect(id: &str, name: &str) -> Option<&'static str> {
    let effect = CATALOGUE.iter().find(|effect| effect.page().id == id)?;
    let shapes = effect.shape().iter().map(|shape| (shape.name, shape.symbol));
    let mut all = shapes.chain(effect.amplitudes().iter().map(|amplitude| (amplitude.name, amplitude.symbol)));
    all.find(|(known, _)| *known == name).map(|(_, symbol)| symbol)
}

/// Symbol of a base parameter, composite or dimension in eq. 11; none where it has none.
pub fn symbol_of_base(name: &str) -> Option<&'static str> {
    let parameter = Parameter::ALL.into_iter().find(|parameter| parameter.artifact_name() == name);
    Some(match parameter {
        Some(Parameter::K1) => "k₁",
        Some(Parameter::K2) => "k₂",
        Some(Parameter::K3) => "k₃",
        Some(Parameter::C10) => "C₁₀",
        Some(Parameter::C01) => "C₀₁",
        Some(Parameter::StrandCompliance) => "E_s",
        Some(Parameter::RubberFriction) => "f'",
        Some(Parameter::StrandFriction) => "f_ss",
        None => match name {
            "c10 + c01" => "C₁₀ + C₀₁",
            "k1 rest_radius^2" => "k₁ r₀²",
            "rest_length" => "L₀",
            "rest_radius" => "r₀",
            "braid_angle" => "α₀",
            "wall_thickness" => "t",
            _ => return None,
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_of_the_catalogue_has_a_symbol_that_its_page_explains() {
        for effect in CATALOGUE {
            let page = effect.page();
            let names = effect.shape().iter().map(|shape| shape.name);
            for name in names.chain(effect.amplitudes().iter().map(|amplitude| amplitude.name)) {
                let symbol = symbol_of_effect(page.id, name).unwrap_or_else(|| panic!("{} {name}", page.id));
                assert!(page.symbols.iter().any(|known| known.symbol == symbol), "{} {name}: {symbol}", page.id);
            }
        }
        assert_eq!(symbol_of_effect("slack", "time_constant_s"), None);
    }

    #[test]
    fn every_base_parameter_has_a_symbol() {
        assert!(Parameter::ALL.iter().all(|parameter| symbol_of_base(parameter.artifact_name()).is_some()));
        assert_eq!(symbol_of_base("k9"), None);
    }
}
