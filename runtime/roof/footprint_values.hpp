#pragma once

// Values of tags as people write them.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace espalier {

constexpr size_t kLongestValue = 100;  // bytes of a text that may mean something

std::string lowered(std::string text);

// A length in metres: 12, "12", "12,5", "12 m", "250 cm", "40 ft", 40', 12'6", 12'-6", 12 ft 6 in. None: something
// else.
std::optional<double> readLength(const nlohmann::json& value);
// A plain number, with a decimal point or comma, or degrees.
std::optional<double> readNumber(const nlohmann::json& value);
// Degrees clockwise from north, or a point of the compass: NNE, north-east, "South". Degrees.
std::optional<double> readDirection(const nlohmann::json& value);
// What a tag says by being there: false for "no", "false", "0" and false itself.
bool readYes(const nlohmann::json& value);

}  // namespace espalier
