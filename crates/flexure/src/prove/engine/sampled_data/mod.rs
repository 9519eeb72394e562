//! Tubes of loops that hold their torques: contraction from one control instant to the next, validated.
//!
//! At instant k the loop is ζ = (q_l, q_m, q̇_l, q̇_m, torques on their way). G_k takes it to the next: the law asks for u(x, t_k), torques are held, in
//! their turn, and the robot moves, exactly. Ellipsoids E_k = {c_k + L_k y, |y| ≤ 1} have floats for c_k and L_k, so that y is a coordinate. If, for every k,
//!
//! 1. all motions from E_k exist until t_{k+1},
//! 2. G_k(c_k + L_k y) − G_k(c_k + L_k y') = L_{k+1} N (y − y') with some N, ‖N‖ ≤ λ_k, for all y, y' in the unit ball,
//! 3. |L_{k+1}⁻¹ (G_k(c_k) − c_{k+1})| ≤ ρ_k and λ_k + ρ_k ≤ 1,
//!
//! then no motion leaves the tube that starts in it, and two of them have |y − y'| at instant k at most Π λ times what it was at the start.
//!
//! *Proof.* By 2 and 3, |L_{k+1}⁻¹ (G_k(c_k + L_k y) − c_{k+1})| ≤ λ_k |y| + ρ_k ≤ 1. ∎
//!
//! 1 is Picard's theorem ([`hold`]); the N of 2 are in products of the intervals that the robot and the law ([`instant`]) have over E_k. L_{k+1} L_{k+1}ᵀ =
//! λ⁻² Φ L_k L_kᵀ Φᵀ + Q in floats with Φ the middle of those and a λ that is asked for: then Φ has norm λ at most, and what intervals leave open goes by
//! directions that Q holds. A torque that would be off by w at each instant is such a Q: it makes the tube as wide as it is asked to be.

pub mod curvature;
pub mod ellipsoid;
pub mod flow;
pub mod fundamental;
pub mod hold;
pub mod instant;
pub mod norm;
pub mod period;
pub mod robot;
pub mod second;
pub mod spread;
pub mod tube;
