within MotionControl;
model ArmBase "Ground on which an arm stands; its acceleration upwards stands for gravity"
  parameter Real gravity(unit = "m/s2") = 9.81 "Acceleration of free fall, against z";
  Frame b "Base axes";
  output Real rate[3](each unit = "rad/s") "Angular velocity";
  output Real place[3](each unit = "m") "Origin";
  output Real turn[3,3](each unit = "1") "From base axes to base axes";
equation
  for i in 1:3 loop
    b.a[i] = if i == 3 then gravity else 0;
    b.z[i] = 0;
    rate[i] = 0;
    place[i] = 0;
    for j in 1:3 loop
      turn[i,j] = if i == j then 1 else 0;
    end for;
  end for;
end ArmBase;
