# Doxygen's input filter for a public header: its first comment is about the file, and what it declares in the namespace
# is a group named after it (pulse_hpp), which a page shows as a whole. Tables of names and fields are left out.
NR == 2 && /^\/\/\/ / { print "/// @file" }
/^}  \/\/ namespace crashsim$/ { print "/// @}" }
/^inline constexpr .* k[A-Za-z0-9]+(Names|Fields|Aliases)(\[\])? ?[={]/ { in_table = 1 }
in_table { if (/};$/) in_table = 0; next }
/^template <>$/ {
  head = $0
  getline
  if (/ (fields|enum_names|enum_aliases)</) {
    in_table = !/;$/
    next
  }
  print head
}
{ print }
/^namespace crashsim {$/ {
  group = FILENAME
  sub(/.*\//, "", group)
  sub(/\./, "_", group)
  print "/// @addtogroup " group
  print "/// @{"
}
