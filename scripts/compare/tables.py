"""RESULTS.md from what was measured."""

from closed_loop import OURS as OURS_LIFT
from identification import OURS as OURS_FIT
from identification_peer import FIRST_SCRIPT


def seconds(value):
    if value is None:
        return "–"
    if value < 1:
        return f"{1e3 * value:.3g} ms"
    return f"{value:.3g} s"


def times(value):
    """A ratio as a reader takes it in."""
    return f"{value:.2g}" if value < 10 else f"{value:,.0f}"


def table(titles, rows, left=1):
    rule = ["---"] * left + ["---:"] * (len(titles) - left)
    return "\n".join("| " + " | ".join(map(str, row)) + " |" for row in [titles, rule, *rows]) + "\n"


def spread(values, form):
    low, high = form.format(min(values)), form.format(max(values))
    return low if low == high else f"{low} to {high}"


def conditions(part):
    return (f"{part['cores']} cores ({part['processor']}), load before the run {part['load_before']:.1f}, "
            f"took {part['took_s'] / 60:.0f} min.")


def verdict(reached, target, found):
    return f"Target: {target}. {'Reached' if reached else 'Missed'}: {found}.\n"


def identification(part):
    lines = {line["name"]: line for line in part["lines"]}
    ours = lines[OURS_FIT]
    rows = []
    for line in part["lines"]:
        rows.append([
            line["name"], line["evaluations"] or "–", spread(line["rmse_n"], "{:.4f}"),
            f"{100 * line['parameter_error']:.2g} %", seconds(line["fit_s"]), seconds(line["whole_s"]),
            seconds(line["processor_s"]), times(line["fit_s"] / ours["fit_s"]), times(line["whole_s"] / ours["whole_s"]),
            times(line["processor_s"] / ours["processor_s"]),
        ])
    swarm = lines["pyswarms GlobalBest"]
    good = [line for name, line in lines.items() if "good start" in name]
    ratio = swarm["whole_s"] / ours["whole_s"]
    matched = swarm["whole_s"] / lines["pam-identify --starts 1"]["whole_s"]
    script = lines[FIRST_SCRIPT]["whole_s"] / ours["whole_s"]
    as_good = max(ours["rmse_n"]) <= min(swarm["rmse_n"])
    faster = [line["whole_s"] / ours["whole_s"] for line in good]
    beaten = [line["name"] for line in part["lines"] if line["evaluations"] and line["fit_s"] < ours["fit_s"]]
    return f"""## Identification

{part['n_rows']:,} rows of `pam-bench --protocol isobaric-triangles` with its sensors' noise, six parameters of eq. 11, the bounds of
`pam-identify`. {part['n_judged']:,} rows count for the peers, and for everyone's RMSE: those more than 0.1 s away from a reversal. The true
parameters leave {part['truth_rmse_n']:.4f} N there. Peers are given the direction of motion, the bounds as a unit box and eq. 11 in NumPy with
all that does not depend on the parameters computed once; it agrees with `pam-predict` to {part['agreement']:.0e} of the largest force. Swarms and
evolution: 60 × 200 moves = {part['budget']:,} evaluations, or their own stop if that comes first; "default" is SciPy's own budget and polish;
local searches stop by themselves. `first script` computes all of eq. 11 each time. {part['n_runs']} seeds.

`whole` is the process from start to end with reading the file; `fit` is the search alone (of `pam-identify`, which also finds
directions, judges quality and computes standard errors by leaving stretches out, everything beyond what `--check` does);
`processor` the time that the whole process kept processors busy, which other work on the machine changes less.

{table(["", "evaluations", "RMSE, N", "worst parameter", "fit", "whole", "processor", "fit, of ours", "whole, of ours",
        "processor, of ours"], rows)}
{verdict(ratio >= 100 and as_good, "100 times as fast as pyswarms, whole program, at equal or lower RMSE",
         f"{times(ratio)} times, RMSE {'not higher' if as_good else 'higher'}; {times(matched)} times with one swarm of as "
         f"many evaluations; {times(script)} times against the first script")}
{verdict(min(faster) >= 1, "whole program not slower than least_squares from its good start",
         f"{times(min(faster))} times as fast as the faster of its two methods")}
{"Faster than ours in the fit alone: " + ", ".join(beaten) + "." if beaten else "No peer is faster in the fit alone."}

{conditions(part)}
"""


def missing_physics(part):
    rows = []
    for line in part["lines"]:
        rows.append([
            line["name"], f"{line['found']} of {line['concealed']}", line["false"],
            f"{100 * line['found'] / (line['found'] + line['false']):.0f} %" if line["found"] + line["false"] else "–",
            f"{line['found_first']}", f"{line['single_first']} of {line['singles']}", f"{line['single_among']}", f"{line['single_alone']}",
            f"{line['nulls_named']} of {line['nulls']}", f"{line['nulls_false']}", seconds(line["seconds"]),
        ])
    ours, *peers = part["lines"]
    both = [line for line in peers if ours["found"] > line["found"] and ours["false"] < line["false"]]
    remarks = [
        f"- {line['name']}: {line['found']} right and {line['false']} false against {ours['found']} and {ours['false']}."
        for line in peers if line not in both
    ]
    balance = lambda line: line["found"] - line["false"]
    best = max(peers, key=balance)
    oracle = max(peers, key=lambda line: line["found_first"])
    return f"""## Missing physics

{part['n_cases']} fresh cases of `prove --generate-only` (seed {part['seed']}): random muscles with one, two, three, no, or nameless effects
concealed; the truth is sealed before anything is diagnosed. Peers regress the residual of the identified model on up to
{part['n_columns']} columns that express the whole catalogue, most in the very form in which effects are concealed, at several inner
parameters, and cleared of what a refit of the base model would absorb. A family of columns is named where any of its columns
has a weight, in order of what they contribute together; where effects make nearly the same column, it counts as right for each. `pam-diagnose` has to say
the very id. STLSQ's threshold is in percent of the deviation of the force; 1 % and 3 % are what it is used with, the others were
added because typical effects lie below them. LASSO's penalty comes from {6} blocked folds. Time of peers: the regression alone, without building
the columns ({seconds(part['building_s'])}), and LASSO's second row takes the folds of its first; ours: the whole process.

{table(["", "right names", "false names", "right of all", "right among as many as concealed", "one concealed: first",
        "among the names", "alone", "none concealed: named some", "false there", "time of a case"], rows)}
{verdict(len(both) == len(peers), "more right names and fewer false ones than every peer",
         f"both against {len(both)} of {len(peers)}" + (", one of the two against" if remarks else ""))}
{chr(10).join(remarks)}

Right minus false: {balance(ours)}, of the best peer ({best['name']}) {balance(best)}. Someone who knew how many effects are concealed
and took only as many names would have {ours['found_first']} right of ours, and {oracle['found_first']} of the best peer's ({oracle['name']}).

{conditions(part)}
"""


def unmodelled_structure(part):
    ours, *peers = part["lines"]
    rows = [
        [
            line["name"], f"{line['left']:.2f}", f"{line['worst']:.2f}", f"{line['harmed']} of {part['n_cases']}",
            "–" if line["terms"] is None else f"{line['terms']:g}",
            "–" if line is ours else f"{line['beaten_by_ours']} of {part['n_cases']}", seconds(line["seconds"]),
        ]
        for line in part["lines"]
    ]
    readable, trees = [line for line in peers if line["terms"] is not None], peers[-1]
    ahead = [line for line in readable if ours["left"] < line["left"]]
    return f"""## Unmodelled structure

{part['n_cases']} fresh cases of `worlds --kind nameless` (seed {part['seed']}{f", {part['refused']} more refused" if part['refused'] else ""}), in
which something is concealed that no effect of the catalogue is. Peers regress what the identified model leaves of the fitted recordings on
{part['n_columns']} columns: what drives a sentence of the grammar (pressure, length, speed, direction, force, time, travel) with the memories
that it may have (lags and play). Error left: of all samples of the held-out recordings, against the force without noise, as a share of what
the identified model leaves. STLSQ's threshold is that with the least error on blocked folds; gplearn (pinned seed) searches 3,000 rows
with a population of 1,000 in 20 generations, and its terms are nodes of the expression; `pam-diagnose` writes a term only where it gains, and its
effects and its static map are part of what it leaves. Time of peers: the regression alone; ours: the whole process.

{table(["", "error left, median", "nine in ten below", "worse than eq. 11", "terms", "ours at least as good", "time of a case"], rows)}
{verdict(len(ahead) == len(readable), "ahead of every readable model", f"ahead of {len(ahead)} of {len(readable)}")}
{verdict(ours["left"] <= 1.2 * trees["left"], "within 1.2 times of boosted trees, which know no physics",
         f"{ours['left'] / trees['left']:.2f} times in the median")}
{conditions(part)}
"""


def inverse_network(part):
    blocks = []
    for line in part["lines"]:
        final = line["final"]
        alike = line["ours"][-1]
        goals = [*(entry["goal"] for entry in alike["to_goal"]), final]
        own = {entry["goal"]: entry["seconds"] for entry in alike["to_goal"]} | {final: alike["whole_s"]}
        rows = []
        for ours in line["ours"]:
            cells = [seconds(entry["seconds"]) + ("" if entry["error"] <= entry["goal"] else f", at {entry['error']:.2g} %")
                     for entry in ours["to_goal"]]
            rows.append([ours["name"], *cells, seconds(ours["whole_s"]), spread(ours["error_percent"], "{:.3f}") + " %"])
        slower = []
        otherwise = {
            words: ({entry["goal"]: entry["seconds"] for entry in ours["to_goal"]}, [])
            for words, ours in zip(("with three starts and judging", "with one start"), line["ours"])
        }
        for peer in line["peers"]:
            cells = []
            for goal, entry in zip(goals, peer["to_goal"]):
                taken = entry["seconds"]
                if taken is None:
                    words = "never" if peer["ended"] else f"not in {seconds(peer['longest_s'])}"
                    cells.append(f"{words} (down to {min(peer['best_percent']):.2g} %)")
                    continue
                cells.append(f"{seconds(taken)} ({times(taken / own[goal])} times)")
                for whole, ratios in otherwise.values():
                    if goal in whole:
                        ratios.append(f"{peer['name']} to {goal:.2g} %: {times(taken / whole[goal])}")
                if taken < 5 * own[goal]:
                    slower.append(f"{peer['name']} to {goal:.2g} %")
            equal = [value for value in peer["at_equal_time"] if value is not None]
            rows.append([f"MLPRegressor {peer['name']}", *cells, spread(equal, "{:.3g}") + " %" if equal else "–"])
        layers = "-".join(map(str, [3, *line["size"], 1]))
        titles = [layers, *(f"to {goal:.2g} %" for goal in goals[:-1]), f"to its own end, {final:.2g} %",
                  f"error after {seconds(alike['whole_s'])}; ours: at its end"]
        blocks.append(table(titles, rows) + "\n" + verdict(
            not slower, "5 times as fast to the same error, one start each",
            f"not against {', '.join(slower)}" if slower else "at every error that a peer reaches")
            + "".join(f"\nOur whole process {words} beside the peers' fit alone, times as fast: {', '.join(ratios)}.\n"
                      for words, (_, ratios) in otherwise.items()))
    return f"""## Inverse network

The model of `datasets/bench-nominal`, {part['n_points']:,} points of the same design, layers and activations alike (tanh, linear output), inputs and
output scaled alike, no regularization; error: RMSE of the pressure on {part['n_held']:,} held-out points of their own, in percent of its range, the
same points for all. Ours is the whole process, by default with three starts and its own judging at 20,000 points by root finding, then
with one start, judged at 100 points, and last as peers are timed: what the program says that its training took. Peers: `fit` alone, one start; adam is watched as it goes for
{part['budget_s']} s, lbfgs runs anew for growing numbers of steps until it ends by itself. Median of {len(part['lines'][0]['peers'][0]['best_percent'])} seeds; ratios
are to our training alone; a cell of ours says the error where it ends above the goal.

{chr(10).join(blocks)}
{conditions(part)}
"""


def closed_loop(part):
    rows = []
    for line in part["lines"]:
        peer = line["peer"]
        rows.append([f"{OURS_LIFT}, steps of {line['step_ms']:g} ms", f"{1e6 * line['error_rad']:.2g} µrad",
                     seconds(line["lift_s"]), seconds(line["whole_s"]), 1, 1])
        rows.append([f"solve_ivp {peer['method']}, rtol {peer['rtol']}", f"{1e6 * peer['error_rad']:.2g} µrad",
                     seconds(peer["fit_s"]), seconds(peer["whole_s"]), times(peer["fit_s"] / line["lift_s"]),
                     times(peer["whole_s"] / line["whole_s"])])
    fewest = min(line["peer"]["fit_s"] / line["lift_s"] for line in part["lines"][:1])
    whole = part["lines"][0]["peer"]["whole_s"] / part["lines"][0]["whole_s"]
    return f"""## Closed loop

`configs/lift.toml` with sensors that neither err nor round, otherwise as it is: 7 s, two arms in `exo-track`, one arm in Python; arm, muscle with
Dahl friction, air, valve with limited flow, delay, and the controller with all its options. The Python plant is integrated from
command to command, as a sampled controller has it. With ever finer steps `exo-track` comes to what `solve_ivp` (DOP853, rtol 1e-10) says: at 0.01
ms the angles differ by {part['agreement_rms_rad']:.1e} rad root mean square, {part['agreement_max_rad']:.1e} at most (the lift itself is tracked to
{part['tracking_max_rad']:.1e}). Accuracy below is the difference from that; the peer is the fastest of RK23, RK45 and LSODA at the
loosest tolerance that is no less accurate.

`lift` is one lift without start and files: of `exo-track` the difference between runs of `--trials` on one thread, which compute more (draws, both
arms); `whole` is the process, of `exo-track` with its CSV of every signal.

{table(["", "accuracy", "lift", "whole", "lift, of ours", "whole, of ours"], rows)}
{verdict(fewest >= 50, "50 times as fast as solve_ivp at the same accuracy, lift for lift", f"{times(fewest)} times; whole processes {times(whole)} times")}
{conditions(part)}
"""


PAGES = {"identification": identification, "missing-physics": missing_physics,
         "unmodelled-structure": unmodelled_structure, "inverse-network": inverse_network, "closed-loop": closed_loop}


def page(results):
    packages = ", ".join(max((part["packages"] for part in results.values()), key=len)).replace("==", " ")
    head = f"""# Side by side

Written by `scripts/compare/compare` (`make compare`); not edited. Each ratio comes from one run on one machine, medians of repetitions that
take turns. Times of programs are whole processes unless said otherwise. Peers: Python {next(iter(results.values()))['python']}, {packages}.

![Times and names side by side](comparison.svg)

"""
    return head + "\n".join(PAGES[name](part) for name, part in results.items())
