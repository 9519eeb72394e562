//! The laws that take part, by name.

use crate::files::{Problem, Problems, suggest};
use crate::laws::{self, About, CONTROLLERS, Controller, Phi, VCBC};
use crate::robot::Robot;

/// A law that takes part: a registered controller, v-CBC with one of its shaping functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entrant {
    kind: &'static str,
    phi: Option<Phi>,
}

/// v-CBC by the names of its shaping functions here, `vcbc` alone for the one that starting gains are of.
fn vcbc(phi: Phi) -> String {
    if phi == Phi::Linear { VCBC.to_owned() } else { format!("{VCBC}:{}", phi.name()) }
}

impl Entrant {
    /// The law of that name: one of `flexure list controllers`, `vcbc:tanh` or `vcbc:coupled-tanh`; `vcbc` is φ linear.
    ///
    /// # Errors
    /// For any other name.
    pub fn named(name: &str) -> Result<Self, Problem> {
        if let Some(&phi) = Phi::ALL.iter().find(|phi| vcbc(**phi) == name) {
            return Ok(Self { kind: VCBC, phi: Some(phi) });
        }
        if let Some(entry) = CONTROLLERS.iter().find(|entry| entry.name == name) {
            return Ok(Self { kind: entry.name, phi: None });
        }
        let shaped: Vec<_> = Phi::ALL.iter().map(|phi| vcbc(*phi)).filter(|name| *name != VCBC).collect();
        let known = std::iter::once(VCBC)
            .chain(shaped.iter().map(String::as_str))
            .chain(CONTROLLERS.iter().map(|entry| entry.name).filter(|name| *name != VCBC));
        let message = format!("no controller is called {}", suggest::quoted(name));
        Err(Problem::new("unknown-name", message, suggest::hint(name, known)))
    }

    /// Name as in `flexure list controllers`, with the shaping function of v-CBC: `vcbc:tanh`.
    pub fn name(self) -> String {
        self.phi.map_or_else(|| self.kind.to_owned(), vcbc)
    }

    /// What the law reads, and what is proved of it.
    pub fn about(self) -> Option<About> {
        laws::about(self.kind)
    }

    /// The law with its starting gains for `robot`. Of the shaping functions, Λ of tanh is that of φ linear, its slope at
    /// no error, and so is κ of the coupled one.
    ///
    /// # Errors
    /// As [`Controller::default_for`].
    pub fn controller(self, robot: &Robot) -> Result<Controller, Problems> {
        Ok(match (Controller::default_for(self.kind, robot)?, self.phi) {
            (Controller::Vcbc(gains), Some(phi)) => Controller::Vcbc(Box::new(gains.shaped_by(phi))),
            (controller, _) => controller,
        })
    }
}

/// The laws of these names, or without names every registered law and `vcbc:tanh`.
///
/// # Errors
/// For an unknown name, and for a law that is named twice.
pub fn entrants(names: &[String]) -> Result<Vec<Entrant>, Problem> {
    if names.is_empty() {
        let registered = CONTROLLERS.iter().map(|entry| entry.name);
        let (first, rest) = (registered.clone().take(1), registered.skip(1));
        let tanh = vcbc(Phi::Tanh);
        return first.chain([tanh.as_str()]).chain(rest).map(Entrant::named).collect();
    }
    let mut chosen: Vec<Entrant> = Vec::new();
    for name in names {
        let entrant = Entrant::named(name.trim())?;
        if chosen.contains(&entrant) {
            let message = format!("{} takes part twice", entrant.name());
            return Err(Problem::new("twice", message, "name each law once"));
        }
        chosen.push(entrant);
    }
    Ok(chosen)
}
