// A state as a frame and back: the frame of a test is dem's complete checkpoint.
#pragma once

#include "common/config/scene.hpp"
#include "common/io/frame.hpp"
#include "dem/state.hpp"

namespace dem {

/// Everything of the state; the caller adds frame number, axial strain, configuration hash, history and the columns of
/// its own (Control). Shear displacements are written only if the scene has friction.
common::Frame to_frame(const State& state, const common::Scene& scene, common::Stage stage);

/// The state of a complete frame. Throws bad_input naming a missing checkpoint dataset.
State to_state(const common::Frame& frame);

/// Contacts of a frame with ids turned into indices; arrays that are absent come out zero.
std::vector<Contact> contacts_in(const common::Contacts& contacts, const Particles& particles);

/// Indices of particles given by id. Throws bad_input naming an id that is not there.
std::vector<std::int32_t> indices_of(const std::vector<std::int64_t>& ids, const Particles& particles);

/// The one value of a checkpoint column. Throws bad_input if it is missing or not a single number.
double checkpoint_value(const common::Frame& frame, const std::string& name);

}  // namespace dem
