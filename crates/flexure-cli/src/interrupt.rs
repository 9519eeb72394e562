//! Ctrl-C: the first asks the job to stop and to print what it has, the second ends the program.
//!
//! A job learns of it from its [`Progress`](crate::progress::Progress), ends, and prints its part of an answer. What looks at no
//! progress, such as a read from a pipe that nobody writes to, is ended from here soon after the signal.

use std::io::{self, Write};
use std::process;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::sync::{Arc, LazyLock};
use std::thread;
use std::time::Duration;

use flexure::files::{Problems, remove_unfinished};
use signal_hook::consts::SIGINT;
use signal_hook::flag::{register, register_conditional_shutdown};

use crate::failure::Failure;
use crate::progress;

/// Exit code of a program that Ctrl-C ends: 128 and the number of the signal.
pub const EXIT_CODE: u8 = 130;

/// How often the watching thread looks.
const GLANCE: Duration = Duration::from_millis(20);

/// How long a job has to come back, and one that has seen the signal.
const PATIENCE: Duration = Duration::from_millis(140);
const PATIENCE_WITH_A_JOB: Duration = Duration::from_secs(2);

static ASKED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);
static SEEN: AtomicBool = AtomicBool::new(false);

/// Who has the word: one answer is printed, and it is whole.
static WORD: AtomicU8 = AtomicU8::new(NOBODY);
const NOBODY: u8 = 0;
/// The command prints an answer that nobody broke off.
const ANSWER: u8 = 1;
/// The command prints what it has.
const PART: u8 = 2;
/// The program ends.
const END: u8 = 3;

/// From here on Ctrl-C is listened to; `json` says how the end is told.
pub fn install(json: bool) {
    let both = register_conditional_shutdown(SIGINT, EXIT_CODE.into(), Arc::clone(&ASKED))
        .and_then(|_| register(SIGINT, Arc::clone(&ASKED)));
    // Where signals cannot be listened to, Ctrl-C does what it did.
    if both.is_ok() {
        let _ = thread::Builder::new().name("interrupt".to_owned()).spawn(move || watch(json));
    }
}

/// Whether the job is asked to stop.
pub fn asked() -> bool {
    let asked = ASKED.load(Ordering::Relaxed);
    if asked {
        SEEN.store(true, Ordering::Relaxed);
    }
    asked
}

/// Takes the word to print; never returns if the program is about to end.
pub fn speak() {
    let who = if ASKED.load(Ordering::SeqCst) { PART } else { ANSWER };
    if WORD.compare_exchange(NOBODY, who, Ordering::SeqCst, Ordering::SeqCst) == Err(END) {
        loop {
            thread::park();
        }
    }
}

/// Ends what does not end by itself.
fn watch(json: bool) {
    while !ASKED.load(Ordering::SeqCst) {
        thread::sleep(GLANCE);
    }
    thread::sleep(PATIENCE);
    if SEEN.load(Ordering::Relaxed) && WORD.load(Ordering::SeqCst) == NOBODY {
        thread::sleep(PATIENCE_WITH_A_JOB);
    }
    match WORD.compare_exchange(NOBODY, END, Ordering::SeqCst, Ordering::SeqCst) {
        Ok(_) => {
            progress::clear();
            remove_unfinished();
            let failure = Failure::from(Problems::interrupted());
            if let Some(errors) = failure.errors().filter(|_| json) {
                let document = serde_json::to_string_pretty(&errors).unwrap_or_default();
                // Nobody can be told that stdout is gone.
                let _ = writeln!(io::stdout(), "{document}");
            }
            failure.say();
        }
        // It is printing and will end.
        Err(PART) => return,
        // It would have ended by now if somebody read what it prints.
        Err(_) => {}
    }
    process::exit(EXIT_CODE.into());
}
