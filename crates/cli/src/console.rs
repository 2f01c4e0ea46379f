//! Notes, warnings and progress on standard error.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};

use crate::exit::visible;
use crate::message::{Drawn, Format, Message, Said, Step};

/// Work shorter than this shows no bar, and two lines of progress are this far apart.
const SHOW_AFTER: Duration = Duration::from_secs(1);

/// Standard error of one run. Notes and bars keep out of each other's way; a clone writes to the same place.
#[derive(Debug, Clone)]
pub struct Console {
    quiet: bool,
    format: Format,
    bars: MultiProgress,
}

impl Console {
    /// With `quiet`, neither notes nor warnings nor bars appear; errors are none of the console's business.
    pub fn new(quiet: bool, format: Format) -> Self {
        Self { quiet, format, bars: MultiProgress::new() }
    }

    /// Whether notes are silenced.
    pub fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// One line worth knowing: what was assumed, found or written.
    pub fn note(&self, text: impl AsRef<str>) {
        self.message(|| Message::Note(Said::new(text.as_ref())));
    }

    /// One line that may change what a person does next: what was repaired, dropped or is doubtful.
    pub fn warn(&self, text: impl AsRef<str>) {
        self.message(|| Message::Warning(Said::new(text.as_ref())));
    }

    /// Text of several lines, as it is: a table, for instance.
    pub fn text(&self, text: impl AsRef<str>) {
        let message = visible(text.as_ref().trim_end_matches('\n'));
        self.message(|| Message::Table(Drawn { message }));
    }

    /// A bar for `steps` steps of work called `label`. It appears once the work has taken a second, on a terminal
    /// only or as lines for machines; dropping it clears it.
    pub fn progress(&self, label: impl Into<String>, steps: u64) -> Progress {
        let bar = ProgressBar::hidden();
        bar.set_length(steps);
        bar.set_message(visible(&label.into()));
        let shows = match self.format {
            _ if self.quiet => Shows::Nothing,
            Format::Json => Shows::Lines(Mutex::new(SHOW_AFTER)),
            Format::Text if std::io::IsTerminal::is_terminal(&std::io::stderr()) => {
                Shows::Bar { shown: AtomicBool::new(false) }
            }
            Format::Text => Shows::Nothing,
        };
        Progress { bar, bars: self.bars.clone(), shows }
    }

    fn message(&self, message: impl FnOnce() -> Message) {
        if !self.quiet {
            self.bars.suspend(|| message().write(self.format));
        }
    }
}

/// Progress of one piece of work; see [`Console::progress`]. May be shared between threads.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    bars: MultiProgress,
    shows: Shows,
}

/// What is seen of a progress.
#[derive(Debug)]
enum Shows {
    Nothing,
    /// A bar, once the work has taken a while.
    Bar {
        /// Whether it has been put on the terminal.
        shown: AtomicBool,
    },
    /// Lines for machines; holds the time from the start to the next line.
    Lines(Mutex<Duration>),
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

    /// `step` of `steps` steps are done altogether.
    pub fn set_of(&self, step: u64, steps: u64) {
        self.bar.set_length(steps);
        self.set(step);
    }

    fn show_if_slow(&self) {
        match &self.shows {
            Shows::Nothing => {}
            Shows::Bar { shown } => {
                if shown.load(Ordering::Relaxed) || self.bar.elapsed() < SHOW_AFTER {
                    return;
                }
                if !shown.swap(true, Ordering::Relaxed) {
                    self.bars.add(self.bar.clone());
                    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %  {eta} left");
                    self.bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
                }
            }
            Shows::Lines(next) => {
                // Another thread that writes a line at this moment writes the one that would come from here.
                let Ok(mut next) = next.try_lock() else { return };
                let elapsed = self.bar.elapsed();
                if elapsed >= *next {
                    *next = elapsed + SHOW_AFTER;
                    self.line(elapsed);
                }
            }
        }
    }

    fn line(&self, elapsed: Duration) {
        let (done, total) = (self.bar.position(), self.bar.length().unwrap_or(0));
        let left_s = elapsed.as_secs_f64() * total.saturating_sub(done) as f64 / done as f64;
        // Tenths are more than such an estimate is worth.
        let seconds_left = left_s.is_finite().then(|| (10.0 * left_s).round() / 10.0);
        Message::Progress(Step { task: self.bar.message(), done, total, seconds_left }).write(Format::Json);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Shows::Lines(next) = &self.shows
            && next.lock().is_ok_and(|next| *next > SHOW_AFTER)
        {
            self.line(self.bar.elapsed());
        }
        self.bar.finish_and_clear();
        self.bars.remove(&self.bar);
    }
}
