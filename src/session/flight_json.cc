#include "session/flight_json.h"

#include <array>

#include <nlohmann/json.hpp>

namespace hvas::session {
namespace {

using simulation::FlightTick;

struct Column {
  const char* name;
  double (*get)(const FlightTick&);
};

// Devices give poses that are no numbers: these are what one looks for here.
constexpr std::array kColumns{
    Column{"t_ms", [](const FlightTick& t) { return 1e-6 * static_cast<double>(t.device.t_ns); }},
    Column{"hand", [](const FlightTick& t) { return double(t.hand); }},
    Column{"condition", [](const FlightTick& t) { return double(t.device.condition); }},
    Column{"vendor_code", [](const FlightTick& t) { return double(t.device.vendor_code); }},
    Column{"buttons", [](const FlightTick& t) { return double(t.device.buttons); }},
    Column{"gripping", [](const FlightTick& t) { return double(t.device.is_gripping); }},
    Column{"device_x_m", [](const FlightTick& t) { return t.device.X_DH.p().x(); }},
    Column{"device_y_m", [](const FlightTick& t) { return t.device.X_DH.p().y(); }},
    Column{"device_z_m", [](const FlightTick& t) { return t.device.X_DH.p().z(); }},
    Column{"device_qw", [](const FlightTick& t) { return t.device.X_DH.q().w(); }},
    Column{"device_qx", [](const FlightTick& t) { return t.device.X_DH.q().x(); }},
    Column{"device_qy", [](const FlightTick& t) { return t.device.X_DH.q().y(); }},
    Column{"device_qz", [](const FlightTick& t) { return t.device.X_DH.q().z(); }},
    Column{"device_vx_m_per_s", [](const FlightTick& t) { return t.device.V_DH.v.x(); }},
    Column{"device_vy_m_per_s", [](const FlightTick& t) { return t.device.V_DH.v.y(); }},
    Column{"device_vz_m_per_s", [](const FlightTick& t) { return t.device.V_DH.v.z(); }},
    Column{"wanted_fx_n", [](const FlightTick& t) { return t.out.F_felt_W.f.x(); }},
    Column{"wanted_fy_n", [](const FlightTick& t) { return t.out.F_felt_W.f.y(); }},
    Column{"wanted_fz_n", [](const FlightTick& t) { return t.out.F_felt_W.f.z(); }},
    Column{"given_fx_n", [](const FlightTick& t) { return t.out.F_H_D.f.x(); }},
    Column{"given_fy_n", [](const FlightTick& t) { return t.out.F_H_D.f.y(); }},
    Column{"given_fz_n", [](const FlightTick& t) { return t.out.F_H_D.f.z(); }},
    Column{"given_tx_nm", [](const FlightTick& t) { return t.out.F_H_D.t.x(); }},
    Column{"given_ty_nm", [](const FlightTick& t) { return t.out.F_H_D.t.y(); }},
    Column{"given_tz_nm", [](const FlightTick& t) { return t.out.F_H_D.t.z(); }},
    Column{"gate_actions", [](const FlightTick& t) { return double(t.out.gate_actions); }},
    Column{"state", [](const FlightTick& t) { return double(t.out.state); }},
    Column{"contacts", [](const FlightTick& t) { return double(t.out.contact_count); }},
    Column{"deepest_m", [](const FlightTick& t) { return t.out.deepest; }},
    Column{"insertion_m", [](const FlightTick& t) { return t.out.insertion_depth; }},
    Column{"points_tested", [](const FlightTick& t) { return double(t.out.points_tested); }},
    Column{"effort_level", [](const FlightTick& t) { return double(t.effort_level); }},
    Column{"wake_up_us", [](const FlightTick& t) { return 1e-3 * double(t.wake_up_ns); }},
    Column{"compute_us", [](const FlightTick& t) { return 1e-3 * double(t.compute_ns); }},
};

}  // namespace

std::string MakeFlightJson(const std::vector<FlightTick>& ticks) {
  nlohmann::json columns = nlohmann::json::array();
  for (const Column& column : kColumns) {
    columns.push_back(column.name);
  }
  nlohmann::json rows = nlohmann::json::array();
  for (const FlightTick& tick : ticks) {
    nlohmann::json row = nlohmann::json::array();
    for (const Column& column : kColumns) {
      row.push_back(column.get(tick));  // what is not finite is written as null
    }
    rows.push_back(std::move(row));
  }
  return nlohmann::json{{"columns", columns}, {"ticks", rows}}.dump();
}

}  // namespace hvas::session
