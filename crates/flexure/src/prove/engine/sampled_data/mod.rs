//! Tubes of loops that hold their torques: contraction from one control instant to the next, validated.
//!
//! At instant k the loop is ζ = (q_l, q_m, q̇_l, q̇_m, what filters remember, torques on their way). G_k takes it to the next: the law asks for u(x̂, t_k), x̂ what is
//! read of ζ ([`sensors`]), positions off by e, |e_i| ≤ r_i, at that instant; torques are held, in their turn, and the robot moves, exactly. Sections
//! E_k = {c_k + L_k y + P_k z, |y| ≤ 1, |z_i| ≤ 1} have floats for c_k, L_k and P_k; z has some of the errors e of instants before, as parts of what they may be, the oldest first: z_{k+1} is z_k and e_k, without
//! the oldest. If, for every k,
//!
//! 1. all motions from E_k exist until t_{k+1},
//! 2. G_k(c_k + L_k y + P_k z, e) − G_k(c_k + L_k y' + P_k z, e) = L_{k+1} N (y − y') with some N, ‖N‖ ≤ λ_k, for all y, y' in the unit ball and all such z and e,
//! 3. |L_{k+1}⁻¹ (G_k(c_k, 0) − c_{k+1})| ≤ ρ_k, |L_{k+1}⁻¹ (G_k(c_k + P_k z, e) − G_k(c_k, 0) − P_{k+1} z_{k+1})| ≤ σ_k for all of them, and λ_k + ρ_k + σ_k ≤ 1,
//!
//! then no motion leaves the tube that starts in it, whatever the readings are off by; |y| at instant k + 1 is at most λ_k |y| + ρ_k + σ_k; and two motions of the same e
//! have |y − y'| at instant k at most Π λ times what it was at the start.
//!
//! *Proof.* By 2 and 3, |y_{k+1}| = |L_{k+1}⁻¹ (G_k(c_k + L_k y + P_k z, e) − c_{k+1} − P_{k+1} z_{k+1})| ≤ λ_k |y| + σ_k + ρ_k ≤ 1. ∎
//!
//! 1 is Picard's theorem ([`hold`]); the N of 2 are in products of the intervals that the robot and the law ([`instant`]) have over E_k. L_{k+1} L_{k+1}ᵀ =
//! λ⁻² Φ L_k L_kᵀ Φᵀ + Q in floats with Φ the middle of those and a λ that is asked for: then Φ has norm λ at most, and what intervals leave open goes by
//! directions that Q holds, as do readings. A torque that would be off by w at each instant is such a Q: it makes the tube as wide as it is asked to be.

pub mod ahead;
pub mod bends;
pub mod curvature;
pub mod flow;
pub mod frame;
pub mod fundamental;
pub mod hold;
pub mod instant;
pub mod links;
pub mod norm;
pub mod path;
pub mod period;
pub mod quadratic;
pub mod second;
pub mod section;
pub mod sensors;
pub mod spread;
pub mod step;
pub mod stretch;
pub mod tube;
pub mod watch;
