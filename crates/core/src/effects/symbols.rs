//! Symbols of parameters, as the equations write them: what artifacts call `time_constant_s` is `τ` there.

use crate::force::Parameter;

/// Parameters of effects: id, name in artifacts, symbol.
const OF_EFFECTS: [(&str, &str, &str); 55] = [
    ("braid-lockup", "lock_contraction", "ε_l"),
    ("braid-lockup", "onset_contraction", "w"),
    ("braid-lockup", "stiffness_n", "K"),
    ("channel-delay", "pressure_delay_s", "d_p"),
    ("channel-delay", "length_delay_s", "d_L"),
    ("end-taper", "cotangent_of_taper", "1/tan β"),
    ("end-taper", "bulge_of_taper", "c"),
    ("fatigue-wear", "exponent", "γ"),
    ("fatigue-wear", "loss_per_reference_travel", "d"),
    ("force-drift", "warm_up_s", "τ"),
    ("force-drift", "drift_n_per_s", "d"),
    ("force-drift", "warm_up_n", "w"),
    ("force-step", "recording", "recording"),
    ("force-step", "instant_s", "t₀"),
    ("force-step", "step_n", "A"),
    ("inertia", "mount_hz", "f"),
    ("inertia", "mass_kg", "m"),
    ("load-dependent-friction", "friction_per_load", "μΘ"),
    ("mullins-softening", "softening_contraction", "ε_c"),
    ("mullins-softening", "softening", "d"),
    ("mullins-softening", "settling_travel", "s_c"),
    ("mullins-softening", "settling", "e"),
    ("presliding-hysteresis", "slip_distance_m", "δ"),
    ("presliding-hysteresis", "slide_at_rest", "κ"),
    ("pressure-creep", "time_constant_s", "τ"),
    ("pressure-creep", "share_of_length", "s"),
    ("pressure-creep", "overstress", "g₁"),
    ("pressure-creep", "slow_overstress", "g₂"),
    ("pressure-creep", "slowest_overstress", "g₃"),
    ("pressure-gauge-hysteresis", "slip_pressure_pa", "r"),
    ("pressure-gauge-hysteresis", "width_pa", "b"),
    ("pressure-lag", "time_constant_s", "τ"),
    ("rate-dependent-hysteresis", "onset_speed_m_per_s", "v₀"),
    ("rate-dependent-hysteresis", "friction_per_e_fold", "f_r"),
    ("rubber-hysteresis", "slip_distance_m", "δ"),
    ("rubber-hysteresis", "width_n", "W"),
    ("series-compliance", "compliance_m_per_n", "c"),
    ("series-compliance", "sliding_share", "s"),
    ("series-compliance", "hardening_per_n", "q"),
    ("slack", "floor_n", "F_floor"),
    ("slack", "softness_n", "w"),
    ("stribeck", "stribeck_speed_m_per_s", "v_s"),
    ("stribeck", "exponent", "n"),
    ("stribeck", "aging_per_s", "a"),
    ("stribeck", "static_friction", "f_s"),
    ("thermal-softening", "time_constant_s", "τ"),
    ("thermal-softening", "softening_per_kilowatt", "d"),
    ("thermal-softening", "softening_per_kelvin", "e"),
    ("threshold-pressure", "threshold_pa", "p_th"),
    ("viscoelastic-relaxation", "time_constant_s", "τ"),
    ("viscoelastic-relaxation", "overstress", "g₁"),
    ("viscoelastic-relaxation", "slow_overstress", "g₂"),
    ("viscoelastic-relaxation", "slowest_overstress", "g₃"),
    ("viscous-damping", "damping_n_s_per_m", "c₀"),
    ("viscous-damping", "damping_with_pressure_n_s_per_m", "c₁"),
];

/// Symbol of parameter `name` of effect `id` in its equation; none where the equation has no single one.
pub fn symbol_of_effect(id: &str, name: &str) -> Option<&'static str> {
    OF_EFFECTS.iter().find(|(effect, parameter, _)| *effect == id && *parameter == name).map(|(_, _, symbol)| *symbol)
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
    use crate::effects::CATALOGUE;

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
        let known = |id: &str| CATALOGUE.iter().any(|effect| effect.page().id == id);
        assert!(OF_EFFECTS.iter().all(|(id, _, _)| known(id)));
    }

    #[test]
    fn every_base_parameter_has_a_symbol() {
        assert!(Parameter::ALL.iter().all(|parameter| symbol_of_base(parameter.artifact_name()).is_some()));
        assert_eq!(symbol_of_base("k9"), None);
    }
}
