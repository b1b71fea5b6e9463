// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/damaged_hdf5.hpp"

#include "tests/fuzz/input.hpp"

#include <hdf5.h>

namespace isostat::fuzz
{
namespace
{
std::vector<Member> members_of(hid_t file)
{
  std::vector<Member> all;
  const auto visit = [](hid_t, const char *name, const auto *, void *out) -> herr_t {
    static_cast<std::vector<Member> *>(out)->push_back({name, {}});
    return 0;
  };
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, visit, &all, H5O_INFO_BASIC);
  const std::size_t n_objects = all.size();
  for (std::size_t k = 0; k < n_objects; ++k)
    {
      const std::string object = all[k].object;
      std::vector<std::string> names;
      const auto add = [](hid_t, const char *name, const H5A_info_t *, void *out) -> herr_t {
        static_cast<std::vector<std::string> *>(out)->emplace_back(name);
        return 0;
      };
      const hid_t id = H5Oopen(file, object.c_str(), H5P_DEFAULT);
      H5Aiterate2(id, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names);
      H5Oclose(id);
      for (const std::string &name : names)
        all.push_back({object, name});
    }
  return all;
}

/// Type, shape and values of a new dataset or attribute.
struct Content
{
  hid_t type = -1, space = -1;
  std::vector<std::uint64_t> words; ///< the values, in whatever type
  const char *text = nullptr;       ///< of a string of variable length
  bool stored = true;               ///< not more rows than there are values for

  explicit Content(Choices &choices)
  {
    constexpr std::size_t most = 1000;
    std::size_t n = 1;
    std::vector<hsize_t> shape;
    for (std::size_t rank = choices.below(4); rank > 0; --rank)
      {
        constexpr std::array<hsize_t, 12> sizes = {0, 1, 2, 3, 4, 7, 64, 63, 65, 192, 256, 191};
        shape.push_back(std::min<hsize_t>(choices.one_of(sizes), most / std::max<std::size_t>(n, 1)));
        n *= shape.back();
      }
    space =
        shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
    choose_type(choices);
    if (shape.size() == 1 && choices.below(16) == 0)
      {
        const hsize_t rows = 1'000'000'000'000;
        H5Sset_extent_simple(space, 1, &rows, nullptr);
        stored = false;
      }
    const bool real = choices.below(2) == 0;
    const double x = choices.number();
    const std::uint64_t k = choices.count();
    words.assign(2 * n + 2, k); // as long as the widest type
    if (real)
      for (std::uint64_t &word : words)
        std::memcpy(&word, &x, sizeof x);
    if (H5Tis_variable_str(type) > 0)
      for (std::uint64_t &word : words)
        word = reinterpret_cast<std::uint64_t>(text);
  }
  ~Content()
  {
    H5Tclose(type);
    H5Sclose(space);
  }
  Content(const Content &) = delete;
  Content &operator=(const Content &) = delete;

private:
  void choose_type(Choices &choices)
  {
    constexpr std::array<const char *, 4> texts = {"", "isostat-specimen", "1e300",
                                                   "\xff\xfe a long text without any sense"};
    const std::array<hid_t, 7> types = {H5T_NATIVE_DOUBLE, H5T_NATIVE_UINT64, H5T_NATIVE_UINT32, H5T_NATIVE_INT64,
                                        H5T_NATIVE_FLOAT,  H5T_NATIVE_UINT8,  H5T_C_S1};
    text = choices.one_of(texts);
    const hid_t chosen = choices.one_of(types);
    type = H5Tcopy(chosen);
    if (H5Tget_class(type) == H5T_STRING)
      H5Tset_size(type, choices.below(2) == 0 ? H5T_VARIABLE : 8);
  }
};

void remove_member(hid_t file, const Member &member)
{
  if (!member.attribute.empty())
    H5Adelete_by_name(file, member.object.c_str(), member.attribute.c_str(), H5P_DEFAULT);
  else if (member.object != ".")
    H5Ldelete(file, member.object.c_str(), H5P_DEFAULT);
}

void add_dataset(hid_t file, const std::string &name, Choices &choices)
{
  const Content content(choices);
  const hid_t id = H5Dcreate2(file, name.c_str(), content.type, content.space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (content.stored)
    H5Dwrite(id, content.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, content.words.data());
  H5Dclose(id);
}

void add_attribute(hid_t file, const std::string &object, const std::string &name, Choices &choices)
{
  const Content content(choices);
  const hid_t id = H5Acreate_by_name(file, object.c_str(), name.c_str(), content.type, content.space, H5P_DEFAULT,
                                     H5P_DEFAULT, H5P_DEFAULT);
  if (content.stored)
    H5Awrite(id, content.type, content.words.data());
  H5Aclose(id);
}

constexpr std::size_t most_values = 1'000'000; ///< a dataset that was damaged before may claim any number

/// One value of a dataset, of whatever type.
void change_value(hid_t file, const Member &member, Choices &choices)
{
  const hid_t id = H5Dopen2(file, member.object.c_str(), H5P_DEFAULT);
  if (id < 0)
    return;
  const hid_t space = H5Dget_space(id), type = H5Dget_type(id);
  const auto n = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
  if (n > 0 && n <= most_values && (H5Tget_class(type) == H5T_FLOAT || H5Tget_class(type) == H5T_INTEGER))
    {
      std::vector<double> numbers(n);
      std::vector<std::uint64_t> counts(n);
      const bool real = H5Tget_class(type) == H5T_FLOAT;
      const hid_t memory = real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_UINT64;
      void *values = real ? static_cast<void *>(numbers.data()) : counts.data();
      H5Dread(id, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
      for (std::size_t changes = 1 + choices.below(3); changes > 0; --changes)
        {
          const std::size_t at = choices.below(n);
          numbers[at] = choices.number(), counts[at] = choices.count();
        }
      H5Dwrite(id, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    }
  H5Tclose(type), H5Sclose(space), H5Dclose(id);
}

/// @pre some of the members may be gone: HDF5 refuses what is asked of those
void damage(hid_t file, const std::vector<Member> &all, Choices &choices)
{
  const Member &member = all[choices.below(all.size())], &other = all[choices.below(all.size())];
  switch (choices.below(6))
    {
    case 0:
      return remove_member(file, member);
    case 1:
    case 2:
      if (member.attribute.empty())
        return change_value(file, member, choices);
      [[fallthrough]];
    case 3: // in its place
      remove_member(file, member);
      return member.attribute.empty() ? add_dataset(file, member.object, choices)
                                      : add_attribute(file, member.object, member.attribute, choices);
    case 4: // another one in its place
      remove_member(file, member);
      if (choices.below(2) == 0)
        H5Lcreate_hard(file, other.object.c_str(), file, member.object.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      else
        H5Lcreate_soft(("/" + other.object).c_str(), file, member.object.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      return;
    default: // one more
      return choices.below(2) == 0 ? add_dataset(file, member.object + "/more", choices)
                                   : add_attribute(file, member.object, "more", choices);
    }
}
/// A file in memory. @throws nothing: the target ends if the bytes are no file of HDF5
hid_t open_image(std::string &bytes)
{
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, 1 << 16, false);
  H5Pset_file_image(access, bytes.data(), bytes.size());
  const hid_t file = H5Fopen("fuzz", H5F_ACC_RDWR, access);
  H5Pclose(access);
  require(file >= 0, "the whole file can be opened");
  return file;
}
} // namespace

WholeHdf5::WholeHdf5(std::string bytes) : bytes_(std::move(bytes))
{
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t file = open_image(bytes_);
  members_ = members_of(file);
  H5Fclose(file);
}

std::string WholeHdf5::damaged(Choices &choices) const
{
  std::string bytes = bytes_;
  const hid_t file = open_image(bytes);
  do
    damage(file, members_, choices);
  while (!choices.used_up());
  H5Fflush(file, H5F_SCOPE_GLOBAL);
  bytes.resize(static_cast<std::size_t>(H5Fget_file_image(file, nullptr, 0)));
  H5Fget_file_image(file, bytes.data(), bytes.size());
  H5Fclose(file);
  return bytes;
}
} // namespace isostat::fuzz
