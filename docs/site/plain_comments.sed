# SPDX-License-Identifier: BSD-3-Clause
# For doxygen: marks in comments mean themselves, but for the few commands that headers use.
/\/\/\//{
s/<([a-z][a-z ]+)>/\\<\1\\>/g
s/\\([rnt]\b)/\\\\\1/g
s/@(pre|post|param|return|returns|tparam|throws|file|note)\b/\x01\1/g
s/@/\\@/g
s/\x01/@/g
}
