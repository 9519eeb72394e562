//! Links and motors.

/// Links or motors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The links.
    Link,
    /// The motors.
    Motor,
}

/// Which sides an imperfection is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// One of them.
    One(Side),
    /// Links and motors.
    Both,
}

impl Sides {
    /// Whether `side` is among them.
    pub fn contain(self, side: Side) -> bool {
        match self {
            Self::One(one) => one == side,
            Self::Both => true,
        }
    }
}

impl Side {
    /// Links, motors: the order of everything that is given per side.
    pub const ALL: [Self; 2] = [Self::Link, Self::Motor];

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Link => "link",
            Self::Motor => "motor",
        }
    }
}

/// One side by its name.
pub(crate) const SIDE: &[(&str, Side)] = &[("link", Side::Link), ("motor", Side::Motor)];

/// One side or both by name.
pub(crate) const SIDES: &[(&str, Sides)] =
    &[("link", Sides::One(Side::Link)), ("motor", Sides::One(Side::Motor)), ("both", Sides::Both)];
