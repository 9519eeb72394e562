//! What a drive does when its controller falls silent.

use crate::estimate::positive;
use crate::linalg::Vector;
use crate::memory::{Memory, Port};
use crate::scalar::{Float, Piecewise};

/// Runs in the drive, not in the controller: a command that is older than so many periods of the drive is not given any more. The
/// torque then goes to zero at a rate that the motors bear, and the next command counts again.
///
/// ```
/// use flexure_core::guard::Watchdog;
/// use flexure_core::linalg::Vector;
///
/// // Commands may be one period old; then the torque falls by 1 N m a period.
/// let mut watchdog = Watchdog::new(1, Vector([1.0])).unwrap();
/// let commands = [Some(Vector([2.5])), None, None, None, None, None, Some(Vector([2.0]))];
/// let given = commands.map(|command| watchdog.step(command)[0]);
/// assert_eq!(given, [2.5, 2.5, 1.5, 0.5, 0.0, 0.0, 2.0]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Watchdog<C, const N: usize> {
    /// Periods that a command may be old.
    allowed: u32,
    /// By how much the torque falls per period [N m].
    fall: Vector<C, N>,
    /// Given last [N m].
    torque: Vector<C, N>,
    /// Periods since the last command.
    age: u32,
}

impl<C: Float, const N: usize> Watchdog<C, N> {
    /// For commands at most `allowed` periods old; then the torque falls by `fall` per period [N m], infinite for at once. `None`
    /// unless that is above 0. No torque before the first command.
    pub fn new(allowed: u32, fall: Vector<C, N>) -> Option<Self> {
        let sound = fall.iter().all(|fall| positive(fall) || fall == C::INFINITY);
        sound.then_some(Self { allowed, fall, torque: Vector::ZERO, age: u32::MAX })
    }

    /// The torque of a period of the drive [N m], from the command that came in it, if one did. Of a command what is not finite
    /// is none.
    #[inline]
    pub fn step(&mut self, command: Option<Vector<C, N>>) -> Vector<C, N> {
        match command.filter(|torque| torque.iter().all(C::is_finite)) {
            Some(torque) => (self.torque, self.age) = (torque, 0),
            None => self.age = self.age.saturating_add(1),
        }
        if self.has_tripped() {
            self.torque = Vector::from_fn(|i| {
                let torque = self.torque[i];
                torque - Piecewise::clamp(torque, -self.fall[i], self.fall[i])
            });
        }
        self.torque
    }

    /// Whether the last command is too old.
    #[inline]
    pub fn has_tripped(&self) -> bool {
        self.age > self.allowed
    }
}

/// The last `torque` [N m] and the `age` of the command in periods of the drive.
impl<C: Float, const N: usize> Memory<C> for Watchdog<C, N> {
    #[inline]
    fn memory(&mut self, port: &mut dyn Port<C>) {
        port.joints("torque", "N m", &mut self.torque.0);
        port.word("age", &mut self.age);
    }
}
