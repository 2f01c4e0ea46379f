//! Print the grid of a diagnosis with residuals of base and given effect ids.
#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "an example")]
use pam_core::artifact::ModelArtifact;
use pam_core::force::columns::ForceColumns;
use pam_core::recording::{ReadOptions, read_recording};
use pam_diagnosis::search::{Limits, search};
use pam_diagnosis::state::Setting;
use pam_diagnosis::track::Track;
use pam_identification::prepare::{direct, gate};
fn main() {
    let mut arguments = std::env::args().skip(1);
    let (model, _) = ModelArtifact::read(std::path::Path::new(&arguments.next().unwrap())).unwrap();
    let n: usize = arguments.next().unwrap().parse().unwrap();
    let recordings =
        arguments.map(|path| read_recording(std::path::Path::new(&path), &ReadOptions::default()).unwrap()).collect();
    let gates = gate(recordings).unwrap();
    let largest = gates.iter().map(|gate| gate.quality.largest_pressure_length_n_per_m).fold(0.0, f64::max);
    let prepared = direct(gates, model.direction, model.form).unwrap();
    let track = Track::of(&prepared, model.direction, model.geometry.rest_length_m).unwrap();
    let columns = ForceColumns::new(&model.geometry, model.strand_modulus_pa, model.form, largest);
    let space = pam_diagnosis::base::search_space(&model, &columns);
    let start = pam_diagnosis::base::coordinates(&model, &space);
    let setting = Setting {
        track: &track,
        columns: &columns,
        space: &space,
        muscle: &model.geometry,
        strand_modulus_pa: model.strand_modulus_pa,
        only: None,
    };
    let limits =
        Limits { max_effects: n, excluded: Vec::new(), matters_above_n: None, sensor_floor_n: model.fit.noise_floor_n };
    let found = search(&setting, &start, &model.force_model(), &limits).unwrap();
    let residuals = setting.residuals_n(&found.best.state);
    println!("rec,t,p,l,v,dir,slide,F,settled,r");
    for (instant, residual) in track.instants.iter().zip(&residuals) {
        let m = &instant.moment;
        println!(
            "{},{:.4},{:.1},{:.6},{:.5},{},{:.6},{:.3},{},{:.3}",
            m.recording,
            m.time_s,
            m.pressure_pa,
            m.length_m,
            m.speed_m_per_s,
            m.direction,
            m.slide_m,
            instant.force_n,
            u8::from(instant.settled),
            residual
        );
    }
}
