//! What a file of a robot in closed form holds, and what becomes of a line in the list of links.

use crate::files::field::Field;
use crate::files::table::Table;
use crate::robot::links::Body;

/// Links in closed form as data, with numbers of type `C`: all that a `kind` in `[links]` stands for but its reader. The
/// first joint stands on the base, each of the others on the link before it, and all of them turn.
pub trait ClosedForm<C> {
    /// The name in files.
    const NAME: &'static str;

    /// What it is, with an article.
    const WHAT: &'static str;

    /// Number of joints.
    const JOINTS: usize;

    /// The same links with numbers of another type.
    type With<D>: ClosedForm<D>;

    /// The same links with every number through `f`.
    fn map<D>(&self, f: impl Fn(C) -> D) -> Self::With<D>
    where
        C: Copy;

    /// The bodies, in the order of the joints.
    fn bodies(&mut self) -> Vec<LineBody<'_, C>>;
}

/// A body with its joint, where pictures show it.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    /// The body.
    pub body: Body,
    /// The end of its link in the link frame \[m\], if that is known.
    pub tip: Option<[f64; 3]>,
}

/// A body whose centre of mass lies on the line of its link.
#[derive(Debug)]
pub struct LineBody<'a, C> {
    /// Mass \[kg\].
    pub mass: &'a mut C,
    /// Distance of the centre of mass from the joint \[m\].
    pub com: &'a mut C,
    /// Rotational inertia about the centre of mass [kg m²].
    pub inertia: &'a mut C,
}

/// Links in closed form that can be read.
pub(crate) trait ReadClosedForm: ClosedForm<f64> + Sized {
    /// The keys of `[links]` beside `kind`.
    const KEYS: &'static [&'static str];

    /// Reads them from `[links]`.
    fn read(table: &Table<'_>) -> Option<Self>;

    /// The bodies where pictures show them.
    fn placed(&self) -> Vec<Placed>;

    /// Notes an error at `field` if gravity \[m/s²\] has a part that the closed form leaves out.
    fn check_gravity(gravity: &[f64; 3], field: &Field<'_>);
}

/// Registers closed forms, each by the path of its [`ClosedForm`]; trees are there anyway. The core's links have the name of the
/// file's. `$d` is a dollar sign, for the macro that this one makes for [`sized`](crate::robot::sized::sized).
macro_rules! closed_forms {
    (($d:tt) $($file:ident::$kind:ident),+ $(,)?) => {
        /// [`of_size`](crate::robot::sized::of_size) with the names of the closed forms before its arguments.
        macro_rules! with_closed_forms {
            ($d($d arguments:tt)*) => { $crate::robot::sized::of_size!([$($kind),+] $d($d arguments)*) };
        }
        pub(crate) use with_closed_forms;

        $(
            impl<C: Scalar> FromFile<C, { <$kind as ClosedForm<f64>>::JOINTS }> for robots::$kind<C> {
                fn from_file(links: &Links<C>, gravity: [C; 3], _: &dyn Fn(C) -> f64) -> Option<Self> {
                    match links {
                        Links::$kind(form) => Some(form.core(gravity)),
                        _ => None,
                    }
                }
            }

            impl SideBySide<{ <$kind as ClosedForm<f64>>::JOINTS }> for robots::$kind<f64> {
                type Several = robots::$kind<Several>;

                fn side_by_side(links: &Each<&Self>) -> Option<Self::Several> {
                    let numbers = links.map(|form| numbers(|number| form.map(number)));
                    together(&numbers, |number| links[0].map(number))
                }
            }
        )+

        /// What the links are, as data with numbers of type `C`.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Links<C = f64> {
            $(
                #[doc = concat!("[`", stringify!($kind), "`].")]
                $kind($kind<C>),
            )+
            /// A tree of moving joints, parents before children; fixed joints are already merged into the bodies.
            Tree(Vec<Body<C>>),
        }

        impl<C> Links<C> {
            /// Number of moving joints.
            pub fn joints(&self) -> usize {
                match self {
                    $(Self::$kind(_) => <$kind<C> as ClosedForm<C>>::JOINTS,)+
                    Self::Tree(bodies) => bodies.len(),
                }
            }

            /// What they are, with an article.
            pub(crate) fn what(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => <$kind<C> as ClosedForm<C>>::WHAT,)+
                    Self::Tree(_) => "a tree",
                }
            }

            /// The bodies of a tree; none of a closed form.
            pub(crate) fn tree(&self) -> &[Body<C>] {
                match self {
                    $(Self::$kind(_) => &[],)+
                    Self::Tree(bodies) => bodies,
                }
            }

            /// The bodies of a closed form or of a tree, to be changed.
            fn bodies(&mut self) -> Bodies<'_, C> {
                match self {
                    $(Self::$kind(data) => Bodies::Line(data.bodies()),)+
                    Self::Tree(bodies) => Bodies::Tree(bodies),
                }
            }
        }

        impl Links {
            /// The bodies, in the order of the joints, where pictures show them.
            pub(crate) fn placed(&self) -> Vec<Placed> {
                match self {
                    $(Self::$kind(data) => ReadClosedForm::placed(data),)+
                    Self::Tree(bodies) => bodies.iter().map(|body| Placed { body: body.clone(), tip: None }).collect(),
                }
            }
        }

        impl<C: Copy> Links<C> {
            /// The same links with every number through `f`.
            pub(crate) fn map<D: Copy>(&self, f: impl Fn(C) -> D) -> Links<D> {
                match self {
                    $(Self::$kind(data) => Links::$kind(data.map(f)),)+
                    Self::Tree(bodies) => Links::Tree(bodies.iter().map(|body| body.map(&f)).collect()),
                }
            }
        }

        /// Every closed form: its name, keys, reader and number of joints.
        const CLOSED_FORMS: &[(&str, Kind)] = &[$((
            <$kind as ClosedForm<f64>>::NAME,
            Kind {
                keys: <$kind as ReadClosedForm>::KEYS,
                read: |table, _| {
                    let links = <$kind as ReadClosedForm>::read(table)?;
                    Some(Assembled::closed_form(Links::$kind(links), table.decimals()))
                },
                joints: Some(<$kind as ClosedForm<f64>>::JOINTS),
            },
        )),+];

        /// Notes an error if gravity has a part that the closed form leaves out.
        pub(crate) fn check_gravity(links: &Links, gravity: &[f64; 3], field: Option<Field<'_>>) {
            let Some(field) = field else { return };
            match links {
                $(Links::$kind(_) => <$kind as ReadClosedForm>::check_gravity(gravity, &field),)+
                Links::Tree(_) => {}
            }
        }
    };
}
pub(super) use closed_forms;

#[cfg(test)]
mod tests {
    use flexure_core::linalg::Vector;
    use flexure_core::model::Links as _;
    use flexure_core::robots::Tree;

    use crate::robot::links::{Links, Pendulum, PlanarTwoLink};

    /// What pictures show of a closed form moves, and weighs, as the closed form does: as a tree it has the same dynamics.
    #[test]
    fn bodies_of_pictures_are_those_of_the_closed_form() {
        let gravity = [0.0, 0.0, -9.81];
        let arm =
            PlanarTwoLink { mass: [3.0, 2.0], length: [0.4, 0.3], com: [0.17, 0.11], inertia: [0.05, 0.02] };
        let tree = as_tree::<2>(&Links::PlanarTwoLink(arm), gravity);
        let closed = arm.core(gravity);
        for q in [[0.3, -1.1], [2.0, 0.7]].map(Vector) {
            let difference = (tree.mass_matrix(&q) - closed.mass_matrix(&q)).0;
            assert!(difference.iter().flatten().all(|x| x.abs() < 1e-14), "{difference:?}");
        }
        let pendulum = Pendulum { mass: 1.5, com: 0.4, inertia: 0.03 };
        let tree = as_tree::<1>(&Links::Pendulum(pendulum), gravity);
        let closed = pendulum.core(gravity);
        for q in [0.4, -2.0].map(|q| Vector([q])) {
            let torques = [tree.gravity_torque(&q)[0], closed.gravity_torque(&q)[0]];
            assert!((torques[0] - torques[1]).abs() < 1e-13, "{torques:?}");
            let masses = [tree.mass_matrix(&q).0[0][0], closed.mass_matrix(&q).0[0][0]];
            assert!((masses[0] - masses[1]).abs() < 1e-14, "{masses:?}");
        }
    }

    fn as_tree<const N: usize>(links: &Links, gravity: [f64; 3]) -> Tree<f64, N> {
        let bodies: Vec<_> = links.placed().into_iter().map(|placed| placed.body).collect();
        Tree::from_bodies(&bodies, gravity, |x| x).expect("a tree")
    }
}
