//! A local search that is asked for its points, instead of asking for their costs.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, JoinHandle};

use crate::tune::search::{BestPoint, Search};

/// The local part of a [`Search`] on a thread of its own, which waits while its points are looked at: the method of Powell calls for
/// costs, and searches that go on side by side want to be called.
pub(super) struct Local {
    points: Mutex<Receiver<Vec<f64>>>,
    costs: Sender<f64>,
    thread: JoinHandle<BestPoint>,
}

impl Local {
    /// Begins it.
    pub(super) fn begin(search: Search) -> Self {
        let ((asked, points), (costs, told)) = (channel(), channel());
        let thread = thread::spawn(move || {
            search.local(|x| {
                // Nobody listens: it was broken off.
                let asked = asked.send(x.to_vec()).is_ok();
                if asked { told.recv().unwrap_or(f64::INFINITY) } else { f64::INFINITY }
            })
        });
        Self { points: Mutex::new(points), costs, thread }
    }

    /// The next point; none once it is done.
    pub(super) fn next(&mut self) -> Option<Vec<f64>> {
        self.points.get_mut().unwrap_or_else(PoisonError::into_inner).recv().ok()
    }

    /// What the last point costs.
    pub(super) fn tell(&self, cost: f64) {
        // It waits for nothing else.
        let _ = self.costs.send(cost);
    }

    /// The best point that it has seen.
    pub(super) fn best(self) -> BestPoint {
        drop((self.points, self.costs));
        self.thread.join().expect("a search does not panic")
    }
}
