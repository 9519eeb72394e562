//! The laws that take part, by name.

use crate::files::{Problem, Problems, suggest};
use crate::laws::{CONTROLLERS, Controller, Phi, SideGains};
use crate::robot::Robot;

/// A law that takes part: a registered controller, v-CBC with one of its shaping functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entrant {
    kind: &'static str,
    phi: Option<Phi>,
}

/// v-CBC by the names of its shaping functions here; the first is what `vcbc` alone means.
const VCBC: [(&str, Phi); 3] =
    [("vcbc", Phi::Linear), ("vcbc:tanh", Phi::Tanh), ("vcbc:coupled-tanh", Phi::CoupledTanh)];

impl Entrant {
    /// The law of that name: one of `flexure list controllers`, `vcbc:tanh` or `vcbc:coupled-tanh`; `vcbc` is φ linear.
    ///
    /// # Errors
    /// For any other name.
    pub fn named(name: &str) -> Result<Self, Problem> {
        if let Some(&(_, phi)) = VCBC.iter().find(|(known, _)| *known == name) {
            return Ok(Self { kind: VCBC[0].0, phi: Some(phi) });
        }
        if let Some(entry) = CONTROLLERS.iter().find(|entry| entry.name == name) {
            return Ok(Self { kind: entry.name, phi: None });
        }
        let known = VCBC
            .iter()
            .map(|(name, _)| *name)
            .chain(CONTROLLERS.iter().map(|entry| entry.name).filter(|name| *name != VCBC[0].0));
        let message = format!("no controller is called {}", suggest::quoted(name));
        Err(Problem::new("unknown-name", message, suggest::hint(name, known)))
    }

    /// Name as in `flexure list controllers`, with the shaping function of v-CBC: `vcbc:tanh`.
    pub fn name(self) -> String {
        let variant = VCBC.iter().find(|(_, phi)| self.phi == Some(*phi));
        variant.map_or(self.kind, |(name, _)| name).to_owned()
    }

    /// The law with its starting gains for `robot`. Of the shaping functions, Λ of tanh is that of φ linear, its slope at
    /// no error, and so is κ of the coupled one.
    ///
    /// # Errors
    /// As [`Controller::default_for`].
    pub fn controller(self, robot: &Robot) -> Result<Controller, Problems> {
        let mut controller = Controller::default_for(self.kind, robot)?;
        if let (Controller::Vcbc(gains), Some(phi)) = (&mut controller, self.phi) {
            gains.phi = phi;
            if phi == Phi::CoupledTanh {
                let couple = |side: &mut SideGains| side.kappa = Some(side.shaping.clone());
                couple(&mut gains.link);
                couple(&mut gains.motor);
            }
        }
        Ok(controller)
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
        return first.chain([VCBC[1].0]).chain(rest).map(Entrant::named).collect();
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
