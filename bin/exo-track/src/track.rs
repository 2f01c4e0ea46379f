//! The track: every signal of a lift, as CSV.

use pam_exo::lift::Instant;

/// One signal of an instant.
type Signal = fn(&Instant) -> f64;

/// Signals of one arm: name with unit, and where it is.
const SIGNALS: [(&str, Signal); 21] = [
    ("angle_rad", |i| i.state.q_rad),
    ("velocity_rad_per_s", |i| i.state.dq_rad_per_s),
    ("acceleration_rad_per_s2", |i| i.state.ddq_rad_per_s2),
    ("angle_error_rad", |i| i.reference.q_rad - i.state.q_rad),
    ("velocity_error_rad_per_s", |i| i.reference.dq_rad_per_s - i.state.dq_rad_per_s),
    ("acceleration_error_rad_per_s2", |i| i.reference.ddq_rad_per_s2 - i.state.ddq_rad_per_s2),
    ("measured_angle_rad", |i| i.measured_rad),
    ("load_torque_n_m", |i| i.load_torque_n_m),
    ("muscle_torque_n_m", |i| i.muscle_torque_n_m),
    ("command_torque_n_m", |i| i.command.torque_n_m),
    ("control_torque_n_m", |i| i.command.torque_n_m + i.load_torque_n_m),
    ("command_force_n", |i| i.command.force_n),
    ("muscle_force_n", |i| i.muscle_force_n),
    ("desired_pressure_pa", |i| i.command.desired_pa),
    ("command_pressure_pa", |i| i.command.pressure_pa),
    ("muscle_pressure_pa", |i| i.pressure_pa),
    ("measured_pressure_pa", |i| i.measured_pa),
    ("length_m", |i| i.length_m),
    ("length_rate_m_per_s", |i| i.length_rate_m_per_s),
    ("length_acceleration_m_per_s2", |i| i.length_acceleration_m_per_s2),
    ("friction_state", |i| i.friction_state),
];

/// The track of both arms as CSV; rows of an arm whose lift was given up end there.
pub(crate) fn csv(arms: &[Vec<Instant>; 2]) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    for name in ["time_s", "reference_angle_rad", "reference_velocity_rad_per_s", "reference_acceleration_rad_per_s2"] {
        table.write_field(name)?;
    }
    for arm in ["left", "right"] {
        for (name, _) in SIGNALS {
            table.write_field(format!("{arm}_{name}"))?;
        }
    }
    table.write_record(None::<&[u8]>)?;
    for row in 0..arms[0].len().max(arms[1].len()) {
        let Some(first) = arms[0].get(row).or(arms[1].get(row)) else { break };
        let reference = first.reference;
        table.write_field(format!("{:.4}", first.time_s))?;
        for value in [reference.q_rad, reference.dq_rad_per_s, reference.ddq_rad_per_s2] {
            table.write_field(format!("{value:.9}"))?;
        }
        for arm in arms {
            for (_, signal) in SIGNALS {
                table.write_field(arm.get(row).map_or(String::new(), |instant| tidy(signal(instant)).to_string()))?;
            }
        }
        table.write_record(None::<&[u8]>)?;
    }
    table.into_inner().map_err(|error| error.into_error().into())
}

/// Nine significant digits, finer than any sensor, and without an exponent where none is needed.
fn tidy(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}
