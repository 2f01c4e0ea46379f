# The two commands of the README are `make` and `make test`; the others are for longer work.

CARGO ?= cargo
OUT := out
DATA := datasets/bench-nominal
# Where cargo builds to: target, unless the user's environment or configuration says otherwise. Asked once, when needed.
BIN = $(eval BIN := $(shell $(CARGO) metadata --no-deps --offline --format-version 1 | \
	sed 's/.*"target_directory":"\([^"]*\)".*/\1/')/release)$(BIN)

# Where `make install` puts programs, manual pages and completions.
PREFIX ?= /usr/local
SHARE = $(DESTDIR)$(PREFIX)/share
PROGRAMS := pam-identify pam-predict pam-diagnose pam-train-inverse exo-track pam-bench pam-export pam-fleet pam-compare

.PHONY: all install test check bench compare tables tutorial tutorial-muscle first-hour hard-use odd-inputs mutate short-recordings fuzz datasets recordings prove prove-worlds prove-real prove-added sensitivity fleet-slurm processors mutants clean cargo-is-there

all: cargo-is-there
	@$(CARGO) build --release --locked --bins
	@mkdir -p $(OUT)
	$(BIN)/pam-identify $(DATA)/isobaric-triangles.csv $(DATA)/isometric-ramps.csv $(DATA)/minor-loops.csv \
		$(DATA)/length-steps.csv --holdout $(DATA)/multisine.csv --holdout $(DATA)/lift.csv \
		--muscle configs/muscle-nominal.toml --out $(OUT)/model.json --figure $(OUT)/fit.svg --compare-forms
	$(BIN)/pam-predict $(DATA)/multisine.csv --model $(OUT)/model.json --out $(OUT)/predicted.csv --max-rmse-n 2
	$(BIN)/pam-diagnose $(DATA)/isobaric-triangles.csv $(DATA)/isometric-ramps.csv $(DATA)/minor-loops.csv \
		$(DATA)/length-steps.csv --holdout $(DATA)/multisine.csv --holdout $(DATA)/lift.csv --model $(OUT)/model.json \
		--out $(OUT)/diagnosis.json --report $(OUT)/report.html
	$(BIN)/pam-train-inverse --model $(OUT)/model.json --out $(OUT)/inverse.json --figure $(OUT)/inverse.svg
	$(BIN)/exo-track --config configs/lift.toml --model $(OUT)/model.json --inverse $(OUT)/inverse.json \
		--out $(OUT)/track.csv --metrics $(OUT)/metrics.json --figure $(OUT)/lift.svg
	@echo
	@echo "Report:    $(OUT)/report.html"
	@echo "Figures:   $(OUT)/fit.svg, $(OUT)/inverse.svg, $(OUT)/lift.svg"
	@echo "Artifacts: $(OUT)/model.json, $(OUT)/predicted.csv, $(OUT)/diagnosis.json, $(OUT)/inverse.json, $(OUT)/track.csv, $(OUT)/metrics.json"

# The programs write their own manual pages and completions.
install: cargo-is-there
	@$(CARGO) build --release --locked --bins
	@mkdir -p "$(DESTDIR)$(PREFIX)/bin" "$(SHARE)/man/man1" "$(SHARE)/bash-completion/completions" \
		"$(SHARE)/zsh/site-functions" "$(SHARE)/fish/vendor_completions.d"
	@set -e; for program in $(PROGRAMS); do \
		install -m 755 $(BIN)/$$program "$(DESTDIR)$(PREFIX)/bin/$$program"; \
		$(BIN)/$$program --man >"$(SHARE)/man/man1/$$program.1"; \
		$(BIN)/$$program --completions bash >"$(SHARE)/bash-completion/completions/$$program"; \
		$(BIN)/$$program --completions zsh >"$(SHARE)/zsh/site-functions/_$$program"; \
		$(BIN)/$$program --completions fish >"$(SHARE)/fish/vendor_completions.d/$$program.fish"; \
	done
	@echo "installed $(PROGRAMS) below $(DESTDIR)$(PREFIX)"

test: cargo-is-there
	@$(CARGO) test --locked --workspace

check: cargo-is-there
	@scripts/check

# Benchmarks: functions by divan, whole programs by script.
bench: cargo-is-there
	@$(CARGO) bench --locked --workspace
	@scripts/bench-programs

# Side by side with pyswarms, SciPy, pycma, PINTS, PySINDy and scikit-learn, into scripts/compare; needs Python 3.11, a
# network the first time, and twenty quiet minutes.
compare: cargo-is-there
	@scripts/compare/compare

# Every table and figure of the chain, from seeds, into out/tables.
tables: cargo-is-there
	@$(CARGO) build --release --locked --bins
	@PAM_BIN=$(BIN) scripts/tables

# Every command of datasets/TUTORIAL.md, in an empty folder.
tutorial: cargo-is-there
	@$(CARGO) build --release --locked --bins
	@scripts/run-tutorial --bin $(BIN)

# The same for datasets/TUTORIAL-MUSCLE.md, on a real muscle whose recordings are fetched (make recordings, or
# PAM_RECORDINGS=folder); without them it says that it was skipped.
tutorial-muscle: cargo-is-there
	@$(CARGO) build --release --locked --bins
	@scripts/run-tutorial --bin $(BIN) --muscle

# Twelve tasks of a beginner, from a German LabVIEW log to a C header, by what --help shows in its examples.
first-hour: cargo-is-there
	@$(CARGO) build --release --locked --bins
	@scripts/first-hour --bin $(BIN)

# Kills, full disks, closed pipes, two writers, foreign names.
hard-use: cargo-is-there
	@$(CARGO) build --release --locked --bins
	@scripts/hard-use --bin $(BIN)

# Twelve hundred inputs, each a little wrong: exit code, message and files of every one.
odd-inputs: cargo-is-there
	@$(CARGO) build --release --locked --bins
	@scripts/odd-inputs --bin $(BIN)

# What instruments do to every channel of every shipped recording: named, refused, or not explained.
mutate: cargo-is-there
	@$(CARGO) build --release --locked --bins
	@scripts/mutate --bin $(BIN)

# Clean recordings of 3 s to 10 min, 1 Hz to 20 kHz, 8 to 16 bits: whatever is named there is false. DRAWS recordings.
DRAWS ?= 400
short-recordings: cargo-is-there
	@$(CARGO) build --release --locked --bins
	@scripts/short-recordings --bin $(BIN) --cases $(DRAWS)

# Broken input for every reader: SECONDS for each, one after another.
SECONDS ?= 60
fuzz: cargo-is-there
	@scripts/fuzz/run $(SECONDS)

# Writes the shipped recordings anew, byte for byte.
datasets: cargo-is-there
	@scripts/make-datasets

# Recordings of real muscles, from their origin; needs a network.
recordings:
	@scripts/fetch-recordings

# Physics concealed in fresh recordings, diagnosed without the truth, scored. The full run writes its results into
# scripts/proof; a smaller one, as make prove CASES=24, prints them.
CASES ?= 400
prove: SEED ?= $(shell date +%s)
prove: cargo-is-there
	@$(CARGO) build --release --locked --workspace --bins
	$(BIN)/prove --cases $(CASES) --seed $(SEED) $(if $(filter 400,$(CASES)),--record scripts/proof)

# The same question to worlds that share nothing with the fitter, below out/worlds; 100 cases where CASES is not given.
# HALF=choose is for whoever chooses constants, HALF=report for outcomes, HALF=sealed for other forms in other worlds; KIND=nameless
# and its like draw cases of one kind, SCORE="--trees scripts/proof/boosted-trees.py --leave-out" asks for more.
HALF ?= report
prove-worlds: CASES := $(if $(filter file,$(origin CASES)),100,$(CASES))
prove-worlds: SEED ?= $(shell date +%s)
prove-worlds: WORLDS := $(OUT)/worlds
prove-worlds: cargo-is-there
	@$(CARGO) build --release --locked --workspace --bins
	@rm -rf $(WORLDS)
	$(BIN)/worlds --out $(WORLDS) --cases $(CASES) --seed $(SEED) --half $(HALF) $(if $(KIND),--kind $(KIND))
	$(BIN)/score-worlds $(WORLDS) --bin $(BIN) --json $(WORLDS)/scores.json $(SCORE)

# What halving and doubling each constant that decides does to names and false alarms: hours; it goes on where it stopped.
sensitivity: cargo-is-there
	scripts/proof/sensitivity --work $(OUT)/sensitivity

# The same question to two real muscles, where their recordings are (make recordings, or PAM_RECORDINGS=folder).
prove-real: cargo-is-there
	@$(CARGO) build --release --locked --workspace --bins
	$(BIN)/prove-real $(if $(PAM_RECORDINGS),--recordings $(PAM_RECORDINGS)) --record scripts/proof

# The same with delays, a play of the gauge, steps of the force (SEED=N draws others) and clipping added to them.
prove-added: cargo-is-there
	@$(CARGO) build --release --locked --bins
	scripts/proof/added-faults --bin $(BIN) $(if $(SEED),--seed $(SEED)) --recordings $(or $(PAM_RECORDINGS),recordings) --record scripts/proof

# The workflow of a fleet on a Slurm of two nodes on this machine, where the distribution's packages are installed; needs a
# network the first time.
fleet-slurm: cargo-is-there
	@$(CARGO) build --release --locked --bins
	@scripts/fleet/test-slurm --bin $(BIN)

# Artifacts of the shipped recordings by two builds, one for old processors and one for new ones, compared byte by byte; a quarter
# of an hour.
processors: cargo-is-there
	@scripts/check-processors $(OUT)/processors

# Mistakes put into what decides in a diagnosis, one at a time: the share that its tests notice. Needs cargo-mutants (cargo install
# cargo-mutants --locked). SAMPLE of them, drawn by SEED; SAMPLE=0 is all six hundred, which takes hours.
SAMPLE ?= 60
mutants: SEED ?= 1
mutants: cargo-is-there
	@if $(CARGO) mutants --version >/dev/null 2>&1; then scripts/mutants --sample $(SAMPLE) --seed $(SEED) --out $(OUT); \
	else echo "skipped: cargo-mutants is not installed (cargo install cargo-mutants --locked)"; fi

clean:
	@rm -rf $(OUT)
	@$(CARGO) clean --quiet

cargo-is-there:
	@command -v $(CARGO) >/dev/null || { \
		echo "cargo is missing. Install the Rust toolchain, 1.89 or newer, from https://rustup.rs, then run make again."; \
		exit 2; }
