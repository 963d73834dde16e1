#include "locus.hpp"

namespace slideway {

CarriageReading carriage_reading(const Stations& stations, int body, double pitch_ratio) {
  const auto sensitivity = [&](Component component) {
    return along_cut(stations.setup(), [&](const Pose& pose) {
      return stations.machine().height_sensitivity(body, component, pose);
    });
  };
  return {sensitivity(Component::z), sensitivity(Component::beta), pitch_ratio};
}

bool sees_carriage(const Setup& setup) {
  return setup.quantity == Quantity::height || setup.kind == Kind::slide;
}

}  // namespace slideway
