"""The page RESULTS.md from what results.json keeps."""


def page(results):
    lines = ["# Fleets: what they cost, and what is found", "",
             "Written by `scripts/fleet/measure`, `prove-since`, `prove-group`, `prove-shards` and `test-slurm` from `results.json`; not edited by hand.", ""]
    fleets = [results["fleets"][size] for size in sorted(results.get("fleets", {}), key=int)]
    if fleets:
        lines += [
            "## Cost", "",
            "Processor time of a whole run (identify, predict, diagnose with its page, train an inverse, the fleet's report) and of the "
            "programs themselves within it, as the shell that starts them counts it: other work on the machine counts for both. "
            "The engine's share is what a run takes beyond its programs. The same muscles: the programs' time for those of the first ten "
            "that are in all of these fleets with nothing concealed or broken. Where a program was done anew, the last time is the cost of its "
            "muscle; the engine's share is of all of them. Without an engine: the same programs, one after another, "
            "for muscles drawn at random, over what they took in the run. A second run, where nothing has changed, does nothing but look.", "",
            "| muscles | rows of a recording | programs, per muscle | the same muscles | engine, per muscle | engine over work | without an engine | on the clock | nothing changed, on the clock |",
            "|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
        ]
        lines += [cost(one, shared(fleets)) for one in fleets]
        for one in fleets:
            if one["done_anew"]:
                lines += ["", f"Of {one['muscles']} muscles, {one['done_anew']} were done more than once: a run was broken off, or "
                          "programs had changed since."]
        if any(one["of"] != one["muscles"] for one in fleets):
            lines += ["", "Where fewer muscles are given than a fleet has, its run was ended before it was through: figures are of what was finished."]
        lines += [
            "", "## What is found", "",
            "Muscles drawn at random; effects at twice their typical severity in some of them, one recording broken in others.", "",
            "| muscles | effects concealed | stand out | right name | sound | false alarms | broken | refused by name |",
            "|---:|---:|---:|---:|---:|---:|---:|---:|",
        ]
        for one in fleets:
            lines.append("| " + " | ".join(str(one[key]) for key in (
                "muscles", "concealed", "found", "right_name", "sound", "false_alarms", "broken", "refused_by_name")) + " |")
        for one in fleets:
            for title, key in (("Missed", "missed"), ("False alarms", "alarms"), ("Sound, and refused", "sound_refused"),
                               ("Broken, and not refused", "not_refused")):
                if one[key]:
                    lines += ["", f"{title} among {one['muscles']}:", "", *(f"- {what}" for what in one[key])]
        lines.append("")
    reports = [results["reports"][size] for size in sorted(results.get("reports", {}), key=int)]
    if reports:
        lines += ["## Report", "", "`pam-fleet` alone, on artifacts made by script.", "",
                  "| campaigns | time | peak memory | page |", "|---:|---:|---:|---:|"]
        lines += [f"| {one['muscles']} | {one['clock_s']:.2f} s | {one['peak_mb']:.0f} MB | {one['page_mb']:.1f} MB |"
                  for one in reports]
        lines.append("")
    if "since" in results:
        since = results["since"]
        cases = since["changed"] + since["controls"]
        lines += [
            "## What has changed", "",
            "`pam-diagnose --since` on muscles drawn at random and recorded at two dates (`scripts/fleet/prove-since`): twenty kinds of "
            "changes concealed, every other muscle with an effect that was there before, every other one with other protocols later; "
            "controls without a change. Named: the change stands among what is named. Named alone: nothing else does, and "
            "nothing else explains it as well. Silent: nothing is named that did not change. Thresholds were chosen with these "
            "muscles in view.", "",
            "| changed | named | | named alone | controls | silent, of all | |", "|---:|---:|---:|---:|---:|---:|---:|",
            f"| {since['changed']} | {since['named']} | {100 * since['named'] / since['changed']:.0f} % | {since['alone']} "
            f"| {since['controls']} | {since['silent']} | {100 * since['silent'] / cases:.0f} % |",
        ]
        for title, key in (("Missed", "missed"), ("Said of what did not change", "said")):
            if since[key]:
                lines += ["", f"{title}:", "", *(f"- {what}" for what in since[key])]
        lines.append("")
    if "group" in results:
        lines += together(results["group"])
    if "two_lengths" in results:
        lines += two_lengths(results["two_lengths"])
    if "shards" in results:
        lines += shards(results["shards"])
    if "slurm" in results:
        lines += ["## Slurm", "", results["slurm"], ""]
    if "machine" in results:
        lines += [f"Times measured on {results['machine']}.", ""]
    return "\n".join(lines)


def shared(fleets):
    """Names of those of the first ten muscles that nothing is concealed in or broken of in any of the fleets."""
    return set.intersection(*(set(one["first_ten_s"]) for one in fleets))


def cost(one, shared):
    """Row of a fleet in the table of costs."""
    n, engine_s = one["muscles"], one["engine_s"] - one["all_work_s"]
    of = f" of {one['of']}" if one["of"] != n else ""
    same = f"{sum(one['first_ten_s'][name] for name in shared) / len(shared):.2f} s" if shared else "-"
    again = f"{one['again_clock_s']:.1f} s" if "again_clock_s" in one else "-"
    return (f"| {n}{of} | {one['rows']} | {one['work_s'] / n:.2f} s | {same} | {engine_s / (n + one['done_anew']):.3f} s | {100 * engine_s / one['all_work_s']:.0f} % "
            f"| {100 * one['plain_s'] / one['plain_work_s']:.0f} % of {one['plain']} | {one['clock_s']:.0f} s | {again} |")


def together(group):
    """Rigs of five muscles each, together and one by one."""
    lines = [
        "## Muscles of one rig together", "",
        "`pam-diagnose --group` on five muscles of the independent bench to a rig (`scripts/fleet/prove-group`), with other laws, sensors "
        "and protocols in each. A rig's effect is done to the columns of all of them, with one value; controls have none, every "
        "other one a muscle with an effect of its own. False: names of rigs' effects that are not there. Thresholds were chosen on rigs of "
        f"other seeds; these are from {group['first']} on, judged once.", "",
        "| | concealed | named | false | in controls | false |", "|---|---:|---:|---:|---:|---:|",
        f"| rigs, muscles together | {group['rigs']} | {group['named']} | {group['false']} | {group['sound']} | {group['false_sound']} |",
        f"| muscles, each alone | {group['muscles_concealed']} | {group['named_alone']} | {group['false_alone_concealed']} "
        f"| {group['muscles'] - group['muscles_concealed']} | {group['false_alone_sound']} |",
        "", f"Beside what the rig does, {group['false_own']} of {group['muscles']} muscles keep a name of a rig's effect. What was held out "
        f"(RMSE over all samples, root mean square over the muscles of a rig) is followed worse than by single diagnoses, by more than 1 %, on {group['worse']} of "
        f"{group['rigs'] + group['sound']} rigs.",
    ]
    for title, key in (("Missed", "missed"), ("Said of what is not there", "said")):
        if group[key]:
            lines += ["", f"{title}:", "", *(f"- {what}" for what in group[key])]
    return [*lines, ""]


def two_lengths(real):
    """Two real muscles of one make."""
    lines = ["Two lengths of one make that somebody recorded on one rig (`scripts/fetch-recordings`), one repeat of each length fitted and one "
             f"held out, RMSE over all samples: {real['statement']}", "",
             "| muscle | a single diagnosis names | held out: eq. 11 | alone | together | sensors |", "|---|---|---:|---:|---:|---:|"]
    lines += [f"| {one['name']} | {', '.join(one['alone']) or '-'} | {one['base_all_n']:.2f} N | {one['alone_all_n']:.2f} N | {one['together_all_n']:.2f} N "
              f"| {one['noise_floor_n']:.2f} N |" for one in real["muscles"]]
    return [*lines, ""]


def shards(proof):
    """Recordings whose rows are in several places, beside one process."""
    lines = ["## Shards", ""]
    if "cuttings" in proof:
        lines += [
            "`pam-identify --summary-only` and `--from-summaries` beside one process (`scripts/fleet/prove-shards`). Cut at random, two to five "
            "times; one of the cuts lies in the middle of the longest rest, in that of the longest motion, at a gap or beside it, or at a border "
            "of what is worked on at a time; a recording that is not cut stands beside. Largest relative difference over all cuttings; "
            "directions, excluded samples, noise and thresholds are equal in all of them.", "",
            "| recording | rows | cuttings | passes, at most | parameter | standard error | RMSE and other figures | rows handed over, at most |",
            "|---|---:|---:|---:|---:|---:|---:|---:|",
        ]
        lines += [f"| {one['what']} | {one['rows']:.0f} | {one['cuttings']:.0f} | {one['passes']:.0f} | {one['parameter']:.1e} | {one['stderr']:.1e} "
                  f"| {one['figure']:.1e} | {one['handed_percent']:.0f} % |" for one in proof["cuttings"]]
        lines.append("")
    if "long" in proof:
        one = proof["long"]
        lines += [
            f"One recording of {one['rows']} rows without a gap, in {one['files']} files of {one['file_mb']:.0f} MB: {one['passes']} passes, processor time "
            f"{one['shard_s']:.0f} s for a shard in all of them and {one['merging_s']:.0f} s for merging, {one['whole_s']:.0f} s in one process; summaries "
            f"of at most {one['summary_mb']:.1f} MB; largest relative difference {one['difference']:.1e}.", "",
        ]
    return lines
