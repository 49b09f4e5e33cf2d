#include "scenarios/save.h"

#include "scenarios/written.h"

namespace lcs::scenario {

void put(Value& map, std::string_view key, const Value& value) {
  Entry& entry = map.entries.emplace_back();
  entry.key = key;
  entry.value = value;
}

Value document_of(const Scenario& scenario) {
  return written(Plain{}, scenario);
}

}  // namespace lcs::scenario
