"""The scene of muscle.xml beside the settled force of the model: RMS and largest difference in N where the muscle pulls; then how
far damping is off in N, and the filter of the pressure as a share."""

import math

import mujoco
import numpy as np
import pam_muscle as pam

model = mujoco.MjModel.from_xml_path("muscle.xml")
data = mujoco.MjData(model)
muscle = pam.Muscle.read("model.json")
longest_m = -model.body("muscle_load").pos[2]
low_pa, high_pa = muscle.model["domain"]["pressure_pa"]
short_m, long_m = muscle.model["domain"]["length_m"]


def pull_n(pressure_pa, length_m, speed_m_per_s=0.0):
    """Pull of actuator and springs at a length, with the speed of contraction."""
    mujoco.mj_resetData(model, data)
    data.qpos[0], data.qvel[0] = longest_m - length_m, speed_m_per_s
    data.ctrl[0] = data.act[0] = pressure_pa
    mujoco.mj_forward(model, data)
    return float(data.qfrc_actuator[0] + data.qfrc_passive[0])


differences = []
for pressure_pa in np.linspace(low_pa, high_pa, 11):
    for length_m in np.linspace(short_m, long_m, 23):
        settled_n = muscle.settled_at(pressure_pa, length_m, 0.0)
        if settled_n > 0.0:
            differences.append(pull_n(pressure_pa, length_m) - settled_n)
values = dict(muscle.effects)["viscous-damping"]
damping = values["damping_n_s_per_m"] + values["damping_with_pressure_n_s_per_m"] * high_pa / 3e5
damped_n = pull_n(high_pa, long_m, 0.02) - pull_n(high_pa, long_m) + 0.02 * damping
mujoco.mj_resetData(model, data)
data.ctrl[0] = high_pa
mujoco.mj_step(model, data)
time_constant_s = dict(muscle.effects)["pressure-lag"]["time_constant_s"]
lag = data.act[0] / (high_pa * -math.expm1(-model.opt.timestep / time_constant_s)) - 1.0
print(np.sqrt(np.mean(np.square(differences))), np.max(np.abs(differences)), abs(damped_n), abs(lag))
