-- expect error: instruction limit of 200000000 exceeded: endless loop?
while true do
  pcall(function() while true do end end)
end
