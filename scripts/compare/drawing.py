"""comparison.svg: four panels of bars, for light and dark pages."""

import math
from html import escape

WIDTH, ROW, LABEL, VALUE = 900, 20, 270, 190
STYLE = """
text{font:13px system-ui,sans-serif;fill:#1f2933}.title{font-size:16px;font-weight:600}.note{fill:#5b6770;font-size:12px}
.ours{fill:#1668b8}.peer{fill:#9aa5b1}.false{fill:#d9822b}.axis{stroke:#c3cad1}
@media (prefers-color-scheme:dark){text{fill:#e4e7eb}.note{fill:#a8b3bd}.ours{fill:#5aa9f0}.peer{fill:#7b8794}.false{fill:#f0a050}
.axis{stroke:#4a5560}}
"""


def seconds(value):
    return f"{1e3 * value:.3g} ms" if value < 1 else f"{value:.3g} s"


class Sheet:
    def __init__(self):
        self.parts, self.y = [], 10

    def text(self, x, y, words, kind="", anchor="start"):
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" class="{kind}" text-anchor="{anchor}">{escape(words)}</text>')

    def head(self, title, note):
        self.y += 26
        self.text(10, self.y, title, "title")
        self.y += 18
        self.text(10, self.y, note, "note")
        self.y += 8

    def bars(self, rows, log):
        """Rows of (label, [(value, kind)], words); a value of none is drawn as nothing."""
        values = [value for _, bars, _ in rows for value, _ in bars if value]
        room = WIDTH - LABEL - VALUE - 20
        low, high = (10 ** math.floor(math.log10(min(values))), max(values)) if log else (0, max(values))
        place = (lambda v: math.log(v / low) / math.log(high / low)) if log else (lambda v: v / high)
        top = self.y
        for label, bars, words in rows:
            self.text(LABEL, self.y + 15, label, anchor="end")
            height = (ROW - 5) / len(bars)
            end = 0.0
            for index, (value, kind) in enumerate(bars):
                if not value:
                    continue
                length = max(place(value) * room, 1)
                end = max(end, length)
                at = self.y + 3 + index * height
                self.parts.append(f'<rect x="{LABEL + 8}" y="{at:.1f}" width="{length:.1f}" height="{height:.1f}" class="{kind}"/>')
            self.text(LABEL + 14 + end, self.y + 15, words, "note")
            self.y += ROW
        self.parts.append(f'<line x1="{LABEL + 8}" x2="{LABEL + 8}" y1="{top}" y2="{self.y + 3}" class="axis"/>')
        self.y += 8

    def svg(self):
        height = self.y + 8
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" role="img">'
                f"<title>The programs beside their peers</title><style>{STYLE}</style>\n" + "\n".join(self.parts) + "\n</svg>\n")


def figure(results):
    sheet = Sheet()
    if part := results.get("identification"):
        sheet.head("Identification: whole process", "seconds on a logarithmic axis; worst RMSE over what the true parameters leave")
        rows = []
        for line in part["lines"]:
            over = max(line["rmse_n"]) / part["truth_rmse_n"]
            kind = "ours" if line["name"].startswith("pam-") else "peer"
            rows.append((line["name"], [(line["whole_s"], kind)], f"{seconds(line['whole_s'])}, RMSE × {over:.3f}"))
        sheet.bars(rows, log=True)
    if part := results.get("missing-physics"):
        found = part["lines"][0]["concealed"]
        sheet.head(f"Missing physics: right names (upper bar) and false names (lower bar), {part['n_cases']} cases",
                   f"{found} effects concealed; a method may name any number")
        rows = []
        for index, line in enumerate(part["lines"]):
            bars = [(line["found"], "peer" if index else "ours"), (line["false"], "false")]
            rows.append((line["name"], bars, f"{line['found']} right, {line['false']} false"))
        sheet.bars(rows, log=False)
    if part := results.get("inverse-network"):
        line = part["lines"][0]
        layers = "-".join(map(str, [3, *line["size"], 1]))
        sheet.head(f"Inverse network {layers}: to an RMSE of the pressure, in percent of its range",
                   "seconds on a logarithmic axis; one start each; training alone, of all")
        rows = []
        for index, goal in enumerate(line["ours"][-1]["to_goal"]):
            rows.append((f"{goal['goal']:g} %: ours", [(goal["seconds"], "ours")], seconds(goal["seconds"])))
            for peer in line["peers"]:
                entry = peer["to_goal"][index]
                never = entry["seconds"] is None
                value = peer["longest_s"] if never else entry["seconds"]
                words = seconds(value)
                if never:
                    words = f"not in {words}, {min(peer['best_percent']):.2g} % at best"
                rows.append((f"MLPRegressor {peer['name']}", [(value, "peer")], words))
        sheet.bars(rows, log=True)
    if part := results.get("closed-loop"):
        sheet.head("Closed loop: one lift at the same accuracy", "seconds on a logarithmic axis; two arms in exo-track, one in Python")
        rows = []
        for line in part["lines"]:
            peer = line["peer"]
            rows.append((f"exo-track, steps of {line['step_ms']:g} ms", [(line["lift_s"], "ours")],
                         f"{seconds(line['lift_s'])}, {1e6 * line['error_rad']:.2g} µrad"))
            rows.append((f"solve_ivp {peer['method']}, rtol {peer['rtol']}", [(peer["fit_s"], "peer")],
                         f"{seconds(peer['fit_s'])}, {1e6 * peer['error_rad']:.2g} µrad"))
        sheet.bars(rows, log=True)
    return sheet.svg()
