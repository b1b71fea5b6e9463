// SPDX-License-Identifier: BSD-3-Clause
// Does not compile where warnings are errors; the test `warnings_are_errors` sees to it that it does not.
int main() { int unused; }
