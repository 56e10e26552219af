#include "scene/json_view.h"

#include <cmath>

namespace peelray {

using nlohmann::json;

const json* JsonView::find(const char* key) const {
    if (!value_) return nullptr;
    if (!value_->is_object()) fail("{}: is {}, must be an object", where_, value_->type_name());
    const auto found = value_->find(key);
    return found == value_->end() ? nullptr : &*found;
}

JsonView JsonView::object(const char* key) const {
    const json* value = find(key);
    std::string where = where_ + "." + key;
    if (value && !value->is_object()) fail("{}: is {}, must be an object", where, value->type_name());
    return {value, std::move(where)};
}

std::vector<JsonView> JsonView::objects(const char* key) const {
    std::vector<JsonView> views;
    const json* value = find(key);
    if (!value) return views;
    if (!value->is_array()) fail("{}.{}: is {}, must be an array", where_, key, value->type_name());
    views.reserve(value->size());
    for (size_t i = 0; i < value->size(); ++i) {
        views.emplace_back(&(*value)[i], fmt::format("{}.{}[{}]", where_, key, i));
        if (!(*value)[i].is_object())
            fail("{}: is {}, must be an object", views.back().where(), (*value)[i].type_name());
    }
    return views;
}

std::vector<std::string> JsonView::keys() const {
    std::vector<std::string> names;
    if (value_ && value_->is_object())
        for (const auto& [key, unused] : value_->items()) names.push_back(key);
    return names;
}

double JsonView::required_number(const char* key) const {
    const json* value = find(key);
    if (!value) fail("{}: \"{}\" is missing", where_, key);
    if (!value->is_number()) fail("{}.{}: is {}, must be a number", where_, key, value->type_name());
    return value->get<double>();
}

double JsonView::number(const char* key, double missing) const {
    return has(key) ? checked_float(required_number(key), key) : missing;
}

bool JsonView::flag(const char* key, bool missing) const {
    const json* value = find(key);
    if (!value) return missing;
    if (!value->is_boolean()) fail("{}.{}: is {}, must be true or false", where_, key, value->type_name());
    return value->get<bool>();
}

std::string JsonView::text(const char* key, std::string missing) const {
    const json* value = find(key);
    if (!value) return missing;
    if (!value->is_string()) fail("{}.{}: is {}, must be a string", where_, key, value->type_name());
    return value->get<std::string>();
}

std::vector<std::string> JsonView::texts(const char* key) const {
    std::vector<std::string> out;
    const json* value = find(key);
    if (!value) return out;
    if (!value->is_array()) fail("{}.{}: is {}, must be an array", where_, key, value->type_name());
    for (const json& element : *value) {
        if (!element.is_string()) fail("{}.{}: holds {}, must hold strings only", where_, key, element.type_name());
        out.push_back(element.get<std::string>());
    }
    return out;
}

std::vector<double> JsonView::numbers(const char* key) const {
    std::vector<double> out;
    const json* value = find(key);
    if (!value) return out;
    if (!value->is_array()) fail("{}.{}: is {}, must be an array", where_, key, value->type_name());
    for (const json& element : *value) {
        if (!element.is_number()) fail("{}.{}: holds {}, must hold numbers only", where_, key, element.type_name());
        out.push_back(element.get<double>());
    }
    return out;
}

float JsonView::checked_float(double value, const char* key) const {
    // Largest float; beyond it the conversion is undefined.
    if (!(std::abs(value) <= 3.4028234e38)) fail("{}.{}: {} is no 32-bit floating point number", where_, key, value);
    return static_cast<float>(value);
}

uint64_t JsonView::whole(const json& value, const std::string& where) const {
    if (!value.is_number()) fail("{}: is {}, must be a whole number", where, value.type_name());
    const double number = value.get<double>();
    if (!(number >= 0 && number <= 9007199254740992.0) || number != std::floor(number))
        fail("{}: {} is no whole number from 0 up", where, number);
    return static_cast<uint64_t>(number);
}

uint64_t JsonView::count(const char* key, uint64_t missing) const {
    const json* value = find(key);
    return value ? whole(*value, where_ + "." + key) : missing;
}

uint64_t JsonView::required_count(const char* key) const {
    if (!has(key)) fail("{}: \"{}\" is missing", where_, key);
    return count(key, 0);
}

std::optional<uint32_t> JsonView::index(const char* key, size_t limit, std::string_view what) const {
    if (!has(key)) return std::nullopt;
    const uint64_t value = count(key, 0);
    if (value >= limit) fail("{}.{}: {} is out of range, the file has {} {}", where_, key, value, limit, what);
    return static_cast<uint32_t>(value);
}

uint32_t JsonView::required_index(const char* key, size_t limit, std::string_view what) const {
    const std::optional<uint32_t> value = index(key, limit, what);
    if (!value) fail("{}: \"{}\" is missing", where_, key);
    return *value;
}

std::vector<uint32_t> JsonView::indices(const char* key, size_t limit, std::string_view what) const {
    std::vector<uint32_t> out;
    const json* value = find(key);
    if (!value) return out;
    if (!value->is_array()) fail("{}.{}: is {}, must be an array", where_, key, value->type_name());
    for (const json& element : *value) {
        const uint64_t i = whole(element, where_ + "." + key);
        if (i >= limit) fail("{}.{}: {} is out of range, the file has {} {}", where_, key, i, limit, what);
        out.push_back(static_cast<uint32_t>(i));
    }
    return out;
}

}  // namespace peelray
