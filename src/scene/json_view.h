// A JSON value together with its place in the file, so that every complaint can say where it is.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace peelray {

/// A checked view of a JSON value. A value of the wrong type is an Error that names file and place; a missing one gives
/// the default. The view does not own the JSON.
class JsonView {
  public:
    JsonView(const nlohmann::json* value, std::string where) : value_(value), where_(std::move(where)) {}

    const std::string& where() const { return where_; }
    bool has(const char* key) const { return find(key) != nullptr; }

    /// The object under `key`; an empty object where it is missing.
    JsonView object(const char* key) const;
    /// The elements of the array of objects under `key`; none where it is missing.
    std::vector<JsonView> objects(const char* key) const;
    /// The names of an object's members.
    std::vector<std::string> keys() const;

    double number(const char* key, double missing) const;
    double required_number(const char* key) const;
    bool flag(const char* key, bool missing) const;
    std::string text(const char* key, std::string missing) const;
    std::vector<std::string> texts(const char* key) const;
    std::vector<double> numbers(const char* key) const;
    /// A count, offset or length: an integer in [0, 2^53].
    uint64_t count(const char* key, uint64_t missing) const;
    uint64_t required_count(const char* key) const;
    /// An index below `limit` into `what`, or none where the key is missing.
    std::optional<uint32_t> index(const char* key, size_t limit, std::string_view what) const;
    uint32_t required_index(const char* key, size_t limit, std::string_view what) const;
    /// A list of indices below `limit`.
    std::vector<uint32_t> indices(const char* key, size_t limit, std::string_view what) const;

    /// Exactly N numbers, or `missing`.
    template <size_t N>
    std::array<float, N> vector(const char* key, std::array<float, N> missing) const {
        if (!has(key)) return missing;
        const std::vector<double> values = numbers(key);
        if (values.size() != N) fail("{}.{}: has {} numbers, needs {}", where_, key, values.size(), N);
        std::array<float, N> out;
        for (size_t i = 0; i < N; ++i) out[i] = checked_float(values[i], key);
        return out;
    }

  private:
    const nlohmann::json* find(const char* key) const;
    float checked_float(double value, const char* key) const;
    uint64_t whole(const nlohmann::json& value, const std::string& where) const;

    const nlohmann::json* value_;  ///< an object, checked on use; null: missing, like an empty object
    std::string where_;
};

}  // namespace peelray
