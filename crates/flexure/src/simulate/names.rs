//! The names of what a loop remembers.

use flexure_core::memory::Port;

use crate::simulate::interface::Signal;

/// Writes down name and unit of each number that a walk comes by.
pub(crate) struct Names {
    joints: usize,
    parts: Vec<&'static str>,
    pub(crate) found: Vec<Signal>,
}

impl Names {
    /// Of vectors, the first `joints` entries.
    pub(crate) fn new(joints: usize) -> Self {
        Self { joints, parts: Vec::new(), found: Vec::new() }
    }

    fn push(&mut self, name: &str, unit: &'static str) {
        let name = self.parts.iter().copied().chain([name]).collect::<Vec<_>>().join(".");
        self.found.push(Signal { name, unit });
    }

    fn each(&mut self, name: &str, unit: &'static str, count: usize) {
        for k in 1..=count {
            self.push(&format!("{name}{k}"), unit);
        }
    }
}

impl Port<f64> for Names {
    fn numbers(&mut self, name: &'static str, unit: &'static str, x: &mut [f64]) {
        match x.len() {
            1 => self.push(name, unit),
            count => self.each(name, unit, count),
        }
    }

    fn joints(&mut self, name: &'static str, unit: &'static str, x: &mut [f64]) {
        self.each(name, unit, x.len().min(self.joints));
    }

    fn word(&mut self, name: &'static str, _: &mut u32) {
        self.push(name, "");
    }

    fn flag(&mut self, name: &'static str, _: &mut bool) {
        self.push(name, "");
    }

    fn enter(&mut self, name: &'static str) {
        self.parts.push(name);
    }

    fn leave(&mut self) {
        self.parts.pop();
    }
}
