#pragma once
// Free motion over one substep, and taking over its result.
#include "dem/body.hpp"
#include "dem/domain.hpp"
#include "dem/particles.hpp"

namespace peclet::dem {

/// Move positions into the domain along its periodic axes.
void wrap_positions(const ParticleArrays& particles, const Domain& domain);

/// Motion under gravity, external forces and torques without contacts. Exact for constant force; dt = 0
/// starts from rest and moves nothing.
void predict_motion(const ParticleArrays& particles, Vec3 gravity, Real dt, const Bodies& bodies);

/// The same with contact forces and torques, which come from positions x + v dt/2.
void predict_motion(const ParticleArrays& particles, Vec3 gravity, const ParticleLoads& contacts, Real dt,
                    const Bodies& bodies);

/// Bodies at x + v dt/2, with the velocities and spins of the start.
void place_at_middle(const ParticleArrays& particles, Vec3 gravity, Real dt, const Bodies& bodies);

/// Whether all bodies are at finite positions and velocities.
bool is_finite_motion(const Bodies& bodies, Index count);

/// Positions, velocities and orientations become those of the bodies; with positions_only the first alone.
void accept_motion(const Bodies& bodies, const Domain& domain, bool positions_only,
                   const ParticleArrays& particles);

}  // namespace peclet::dem
