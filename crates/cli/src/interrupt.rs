//! Ctrl-C, termination and panics: no temporary file stays behind, exit code 130, after a panic 101.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, Once, PoisonError};

/// Files that outputs are working on.
#[derive(Debug)]
pub(crate) struct Live {
    /// Temporaries to delete when the program ends early.
    pub(crate) temporaries: BTreeSet<PathBuf>,
    /// Targets that outputs hold, so that no two of them write to one.
    pub(crate) targets: BTreeSet<PathBuf>,
}

impl Live {
    fn delete_temporaries(&self) {
        for path in &self.temporaries {
            let _ = std::fs::remove_file(path);
        }
    }
}

static LIVE: Mutex<Live> = Mutex::new(Live { temporaries: BTreeSet::new(), targets: BTreeSet::new() });

/// The registry; whoever holds it cannot be interrupted, so several renames under one lock are one step.
pub(crate) fn live() -> MutexGuard<'static, Live> {
    LIVE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes Ctrl-C, Ctrl-\\, termination and hang-up delete live temporaries and exit with code 130. Calling it again
/// does nothing.
///
/// Under `nohup` nothing is installed: the handler could not tell a hang-up from the other two, and would
/// end a run that was meant to survive its terminal.
pub fn start() {
    static INSTALLED: Once = Once::new();
    INSTALLED.call_once(|| {
        if hang_up_is_ignored() {
            return;
        }
        // Without a handler the system ends the program just as well; only a temporary may stay behind.
        // First, so that the thread that ctrlc starts inherits what is kept from it.
        #[cfg(unix)]
        end_on_quit();
        let _ = ctrlc::set_handler(end);
    });
}

/// Ends the program without a trace.
fn end() {
    let live = live();
    live.delete_temporaries();
    // The lock is never given back: the main thread must not create another one meanwhile.
    std::process::exit(130);
}

/// The same for Ctrl-\\, a spent share of the processor and whatever else ends a program from outside and can be waited for; and a file that grows beyond what the
/// system allows becomes an error of the write instead of a signal that ends the program on the spot.
///
/// All are kept from every thread (those to come inherit it), and one thread waits for the first.
#[cfg(unix)]
fn end_on_quit() {
    use nix::sys::signal::{SigSet, Signal};
    let mut awaited = SigSet::empty();
    let of_users_and_limits = [Signal::SIGQUIT, Signal::SIGXCPU, Signal::SIGUSR1, Signal::SIGUSR2];
    let of_timers_and_devices = [Signal::SIGALRM, Signal::SIGVTALRM, Signal::SIGPROF, Signal::SIGIO];
    for signal in of_users_and_limits.into_iter().chain(of_timers_and_devices) {
        awaited.add(signal);
    }
    // A power supply that fails, and a fault of a coprocessor that no processor has any more.
    #[cfg(target_os = "linux")]
    for signal in [Signal::SIGPWR, Signal::SIGSTKFLT] {
        awaited.add(signal);
    }
    let mut kept = awaited;
    kept.add(Signal::SIGXFSZ);
    if kept.thread_block().is_err() {
        return;
    }
    let _ = std::thread::Builder::new().name("signals".to_owned()).spawn(move || {
        if awaited.wait().is_ok() {
            end();
        }
    });
}

/// Makes a panic of any thread, once it is reported, delete live temporaries and exit with code 101: nothing is
/// unwound, so that a worker that panics ends the program as the main thread would.
pub(crate) fn end_on_panic() {
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        report(panic);
        // Not waited for: the panicking thread may hold it itself.
        if let Ok(live) = LIVE.try_lock() {
            live.delete_temporaries();
        }
        std::process::exit(101);
    }));
}

/// Whether the program was started with hang-ups ignored; Linux tells, elsewhere it is taken as no.
fn hang_up_is_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap_or("0").trim();
    u64::from_str_radix(ignored, 16).is_ok_and(|mask| mask & 1 == 1)
}
