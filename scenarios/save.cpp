#include "scenarios/save.h"

#include "scenarios/written.h"

namespace lcs::scenario {

void put(input::Value& map, std::string_view key, const input::Value& value) {
  input::Entry& entry = map.entries.emplace_back();
  entry.key = key;
  entry.value = value;
}

input::Value document_of(const Scenario& scenario) {
  return written(Plain{}, scenario);
}

}  // namespace lcs::scenario
