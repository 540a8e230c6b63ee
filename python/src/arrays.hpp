// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace dtof::python {

using Shape = std::vector<pybind11::ssize_t>;

/// A read-only array that shows memory of `owner`, which lives as long as the array does. Strides are in
/// bytes.
template <typename T, typename Owner>
pybind11::array_t<T> shared_array(std::shared_ptr<Owner> owner, const T* data, Shape shape, Shape strides) {
  using Held = std::shared_ptr<Owner>;
  const pybind11::capsule base(new Held(std::move(owner)),
                               [](void* held) { delete static_cast<Held*>(held); });
  pybind11::array_t<T> array(std::move(shape), std::move(strides), data, base);
  array.attr("setflags")(pybind11::arg("write") = false);
  return array;
}

/// A read-only array in C order that takes the vector over.
template <typename T>
pybind11::array_t<T> taken_array(std::vector<T> values, Shape shape) {
  auto held = std::make_shared<const std::vector<T>>(std::move(values));
  Shape strides(shape.size());
  auto step = static_cast<pybind11::ssize_t>(sizeof(T));
  for (std::size_t axis = shape.size(); axis-- > 0;) {
    strides[axis] = step;
    step *= shape[axis];
  }
  const T* data = held->data();
  return shared_array<T>(std::move(held), data, std::move(shape), std::move(strides));
}

/// Numbers of any array, converted where needed, in C order.
template <typename T>
using InputArray = pybind11::array_t<T, pybind11::array::c_style | pybind11::array::forcecast>;

/// The numbers of an array with another shape or kept as they stand.
template <typename T>
std::vector<T> to_vector(const InputArray<T>& array) {
  return {array.data(), array.data() + array.size()};
}

}  // namespace dtof::python
