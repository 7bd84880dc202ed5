// Macros for an early return on errors: TYNDALL_TRY(expression) for Result<void>, and TYNDALL_ASSIGN(declaration,
// expression) for Result<T>.
#pragma once

#include "tyndall/result.hpp"

#define TYNDALL_CONCAT_2(a, b) a##b
#define TYNDALL_CONCAT(a, b) TYNDALL_CONCAT_2(a, b)

#define TYNDALL_TRY(expression)                                 \
  do {                                                          \
    auto try_result = (expression);                             \
    if (!try_result.ok()) return std::move(try_result).error(); \
  } while (false)

#define TYNDALL_ASSIGN_2(result, declaration, expression) \
  auto result = (expression);                             \
  if (!result.ok()) return std::move(result).error();     \
  declaration = std::move(result).value()
#define TYNDALL_ASSIGN(declaration, expression) \
  TYNDALL_ASSIGN_2(TYNDALL_CONCAT(try_result_, __LINE__), declaration, expression)
