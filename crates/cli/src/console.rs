//! Notes, warnings and progress on standard error.

use std::io::Write as _;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};

use crate::exit::flatten;

/// Work shorter than this shows no bar.
const SHOW_AFTER: Duration = Duration::from_secs(1);

/// Standard error of one run. Notes and bars keep out of each other's way; a clone writes to the same place.
#[derive(Debug, Clone)]
pub struct Console {
    quiet: bool,
    bars: MultiProgress,
}

impl Console {
    /// With `quiet`, neither notes nor warnings nor bars appear; errors are none of the console's business.
    pub fn new(quiet: bool) -> Self {
        Self { quiet, bars: MultiProgress::new() }
    }

    /// Whether notes are silenced.
    pub fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// One line worth knowing: what was assumed, found or written.
    pub fn note(&self, text: impl AsRef<str>) {
        self.line("note", text.as_ref());
    }

    /// One line that may change what a person does next: what was repaired, dropped or is doubtful.
    pub fn warn(&self, text: impl AsRef<str>) {
        self.line("warning", text.as_ref());
    }

    /// Text of several lines, as it is: a table, for instance.
    pub fn text(&self, text: impl AsRef<str>) {
        if !self.quiet {
            self.bars.suspend(|| {
                let _ = writeln!(std::io::stderr().lock(), "{}", text.as_ref().trim_end_matches('\n'));
            });
        }
    }

    /// A bar for `steps` steps of work called `label`. It appears on a terminal only, and only once the work
    /// has taken a second; dropping it clears it.
    pub fn progress(&self, label: impl Into<String>, steps: u64) -> Progress {
        let bar = ProgressBar::hidden();
        bar.set_length(steps);
        bar.set_message(label.into());
        let terminal = std::io::IsTerminal::is_terminal(&std::io::stderr());
        let shown = Arc::new(AtomicBool::new(self.quiet || !terminal));
        Progress { bar, bars: self.bars.clone(), shown }
    }

    fn line(&self, kind: &str, text: &str) {
        if !self.quiet {
            self.bars.suspend(|| {
                // A closed standard error must not end a run.
                let _ = writeln!(std::io::stderr().lock(), "{kind}: {}", flatten(text));
            });
        }
    }
}

/// Progress of one piece of work; see [`Console::progress`]. May be shared between threads.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    bars: MultiProgress,
    /// Whether the bar has been put on the terminal, or never will be.
    shown: Arc<AtomicBool>,
}

impl Progress {
    /// `steps` more steps are done.
    pub fn advance(&self, steps: u64) {
        self.bar.inc(steps);
        self.show_if_slow();
    }

    /// `step` steps are done altogether.
    pub fn set(&self, step: u64) {
        self.bar.set_position(step);
        self.show_if_slow();
    }

    fn show_if_slow(&self) {
        if self.shown.load(Ordering::Relaxed) || self.bar.elapsed() < SHOW_AFTER {
            return;
        }
        if !self.shown.swap(true, Ordering::Relaxed) {
            self.bars.add(self.bar.clone());
            let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %  {eta} left");
            self.bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
        self.bars.remove(&self.bar);
    }
}
